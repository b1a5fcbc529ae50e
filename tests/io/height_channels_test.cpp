// Which channel holds the heights, and what is recognised as something else.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "io/foreign_images.h"
#include "io/height_file.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

constexpr int kSide = 64;

using Doubles = std::vector<double>;

// A smooth relief of 0..1 with some roughness.
double relief(int x, int y) {
  return 0.5 + 0.3 * std::sin(0.11 * x + 0.5) * std::cos(0.07 * y) + 0.1 * std::sin(0.31 * x - 0.23 * y) +
         0.02 * std::sin(2.3 * x * 1.7 + y * 3.1);
}

class HeightChannels : public ImageIo {
 protected:
  using Texel = std::function<Doubles(int x, int y)>;

  // Writes an image of kSide² texels. texel: channels of 0..1.
  template <class T = uint8_t>
  void write(const std::string& name, const std::vector<std::string>& channels, const Texel& texel) {
    std::vector<T> values;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        for (const double value : texel(x, y)) {
          if constexpr (std::is_integral_v<T>)
            values.push_back(static_cast<T>(std::lround(value * std::numeric_limits<T>::max())));
          else
            values.push_back(static_cast<T>(value));
        }
    OIIO::ImageSpec spec = spec_of(kSide, kSide, channels);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    write_foreign(folder_ / name, spec, values);
  }
  HeightFile read(const std::string& name, const HeightFileOptions& options = {}) {
    return read_height_file(folder_ / name, options);
  }
  std::string fault(const std::string& name, const HeightFileOptions& options = {}) {
    return error_of<InputError>([&] { read(name, options); });
  }
  void expect_relief(const HeightFile& file, double tolerance) {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) ASSERT_NEAR(file.values(x, y), relief(x, y), tolerance);
  }
};

HeightFileOptions channel(const char* name) {
  HeightFileOptions options;
  options.channel = name;
  return options;
}

HeightFileOptions encoding(SplitEncoding split) {
  HeightFileOptions options;
  options.encoding = split;
  return options;
}

constexpr double kByte = 0.5001 / 255;

TEST_F(HeightChannels, TheOnlyOneThatVariesIsTaken) {
  const auto expect = [&](const char* name, const char* taken) {
    const HeightFile file = read(name);
    EXPECT_EQ(file.channel, taken);
    EXPECT_TRUE(file.holes.values.empty());
    expect_relief(file, kByte);
  };
  write("red.png", {"R", "G", "B"}, [](int x, int y) { return Doubles{relief(x, y), 0, 0}; });
  expect("red.png", "R");
  write("green.png", {"R", "G", "B"}, [](int x, int y) { return Doubles{0, relief(x, y), 0}; });
  expect("green.png", "G");
  write("blue.png", {"R", "G", "B", "A"}, [](int x, int y) { return Doubles{0, 0.5, relief(x, y), 1}; });
  expect("blue.png", "B");
  write("alpha.png", {"R", "G", "B", "A"}, [](int x, int y) { return Doubles{0, 0, 0, relief(x, y)}; });
  expect("alpha.png", "A");
  write<float>("layer.exr", {"R", "G", "B", "ground.height"}, [](int x, int y) {
    return Doubles{0, 0, 0, relief(x, y)};
  });
  expect("layer.exr", "ground.height");
}

TEST_F(HeightChannels, SeveralThatVaryAreNamed) {
  write("rb.png", {"R", "G", "B"}, [](int x, int y) { return Doubles{relief(x, y), 0, relief(y, x)}; });
  EXPECT_THAT(fault("rb.png"), EndsWith("rb.png: has the same value everywhere in channel G, expected "
                                        "--channel to name the one that holds the heights: R, B"));
  EXPECT_EQ(read("rb.png", channel("R")).channel, "R");
  EXPECT_EQ(read("rb.png", channel("G")).channel, "G");
}

TEST_F(HeightChannels, FlatMapsStayFlat) {
  write("flat.png", {"R", "G", "B"}, [](int, int) { return Doubles{0.2, 0.4, 0.6}; });
  EXPECT_EQ(read("flat.png").channel, "G");
  EXPECT_EQ(read("flat.png").values[0], 0.4f);
  // An alpha of 0 and 1 over flat heights is a mask, not the heights.
  write("mask.png", {"R", "G", "B", "A"}, [](int x, int) {
    return Doubles{0.4, 0.4, 0.4, x < 5 ? 0.0 : 1.0};
  });
  const HeightFile file = read("mask.png");
  EXPECT_EQ(file.channel, "G");
  EXPECT_EQ(file.holes(4, 0), 1);
  EXPECT_EQ(file.holes(5, 0), 0);
}

TEST_F(HeightChannels, GreyIsTakenWhateverItsTint) {
  write("grey.png", {"R", "G", "B"}, [](int x, int y) { return Doubles(3, relief(x, y)); });
  expect_relief(read("grey.png"), kByte);
  write("tint.png", {"R", "G", "B"}, [](int x, int y) {
    return Doubles{std::sqrt(relief(x, y)), relief(x, y), 0.6 * relief(x, y)};
  });
  expect_relief(read("tint.png"), kByte);
  write("grey.jpg", {"R", "G", "B"}, [](int x, int y) { return Doubles(3, relief(x, y)); });
  expect_relief(read("grey.jpg"), 0.05);
  // Little contrast under the noise of compression.
  write("faint.png", {"R", "G", "B"}, [](int x, int y) {
    const auto noise = [&](int k) { return ((x * 7 + y * 13 + k * 5) % 5 - 2) / 255.0; };
    const double grey = 0.5 + 0.02 * relief(x, y);
    return Doubles{grey + noise(0), grey + noise(1), grey + noise(2)};
  });
  EXPECT_EQ(read("faint.png").channel, "G");
  write<float>("grey.exr", {"R", "G", "B"}, [](int x, int y) { return Doubles(3, 1000 * relief(x, y)); });
  EXPECT_EQ(read("grey.exr").values(3, 4), static_cast<float>(1000 * relief(3, 4)));
}

TEST_F(HeightChannels, ColourPicturesAreRefused) {
  const Texel picture = [](int x, int y) {
    return Doubles{relief(x, y), relief(y, x), 0.5 + 0.4 * std::sin(0.2 * (x + y))};
  };
  write("photo.png", {"R", "G", "B"}, picture);
  EXPECT_THAT(fault("photo.png"),
              AllOf(HasSubstr("photo.png: looks like a colour picture"), HasSubstr("--channel G")));
  write<uint16_t>("photo.tif", {"R", "G", "B"}, picture);
  EXPECT_THAT(fault("photo.tif"), HasSubstr("looks like a colour picture"));
  write<float>("photo.exr", {"R", "G", "B"}, picture);
  EXPECT_THAT(fault("photo.exr"), HasSubstr("looks like a colour picture"));
  EXPECT_EQ(read("photo.png", channel("G")).channel, "G");
}

TEST_F(HeightChannels, NormalMapsAreRefused) {
  for (const double strength : {1.0, 10.0, 40.0}) {
    const auto normal = [&](int x, int y) {
      const double dx = strength * (relief(x + 1, y) - relief(x - 1, y)) / 2;
      const double dy = strength * (relief(x, y + 1) - relief(x, y - 1)) / 2;
      const double length = std::sqrt(dx * dx + dy * dy + 1);
      return Doubles{-dx / length, -dy / length, 1 / length};
    };
    const auto code = [&](int x, int y) {
      Doubles n = normal(x, y);
      for (double& value : n) value = 0.5 + 0.5 * value;
      return n;
    };
    write("n.png", {"R", "G", "B"}, code);
    EXPECT_THAT(fault("n.png"), HasSubstr("n.png: looks like a normal map")) << strength;
    write<float>("coded.exr", {"R", "G", "B"}, code);
    EXPECT_THAT(fault("coded.exr"), HasSubstr("looks like a normal map")) << strength;
    write<float>("signed.exr", {"R", "G", "B"}, normal);
    EXPECT_THAT(fault("signed.exr"), HasSubstr("looks like a normal map")) << strength;
    // The heights may be beside them.
    write("na.png", {"R", "G", "B", "A"}, [&](int x, int y) {
      Doubles texel = code(x, y);
      texel.push_back(relief(x, y));
      return texel;
    });
    EXPECT_THAT(fault("na.png"), HasSubstr("looks like a normal map"));
    expect_relief(read("na.png", channel("A")), kByte);
  }
}

// Stores x in alpha and y in green (DXT5nm), with other red and blue.
// rest: red and blue of a green.
std::function<Doubles(int, int)> dxt5nm(double strength, const std::function<double(double)>& rest) {
  return [=](int x, int y) {
    const double dx = strength * (relief(x + 1, y) - relief(x - 1, y)) / 2;
    const double dy = strength * (relief(x, y + 1) - relief(x, y - 1)) / 2;
    const double length = std::sqrt(dx * dx + dy * dy + 1), green = 0.5 - 0.5 * dy / length;
    return Doubles{rest(green), green, rest(green), 0.5 - 0.5 * dx / length};
  };
}

TEST_F(HeightChannels, NormalMapsWithXInAlphaAreRefusedOrDoubted) {
  for (const double strength : {3.0, 20.0}) {
    for (const double constant : {0.0, 1 / 255.0, 1.0}) {
      write("n.png", {"R", "G", "B", "A"}, dxt5nm(strength, [&](double) { return constant; }));
      EXPECT_THAT(fault("n.png"),
                  AllOf(HasSubstr("DXT5nm"), HasSubstr("--normal-channels A,G"), HasSubstr("--channel")))
          << strength << " " << constant;
      EXPECT_EQ(read("n.png", channel("G")).doubt, "");
    }
    write("grey.png", {"R", "G", "B", "A"}, dxt5nm(strength, [](double green) { return green; }));
    EXPECT_THAT(read("grey.png").doubt, AllOf(HasSubstr("DXT5nm"), HasSubstr("{channel} G"))) << strength;
  }
}

TEST_F(HeightChannels, GreenAloneIsDoubtedWhereRedAndBlueSaySo) {
  const auto doubt = [&](double red, double blue) {
    write("g.png", {"R", "G", "B"}, [&](int x, int y) {
      return Doubles{red / 255, relief(x, y), blue / 255};
    });
    const HeightFile file = read("g.png");
    expect_relief(file, kByte);
    EXPECT_EQ(read("g.png", channel("G")).doubt, "");
    return file.doubt;
  };
  EXPECT_EQ(doubt(0, 0), "");
  EXPECT_THAT(doubt(130, 0), AllOf(HasSubstr("{encoding} terrarium"), HasSubstr("{channel} G")));
  EXPECT_THAT(doubt(130, 77), HasSubstr("{encoding} terrarium"));
  EXPECT_THAT(doubt(1, 0), HasSubstr("{encoding} mapbox"));
  EXPECT_THAT(doubt(1, 140), HasSubstr("{encoding} mapbox"));
  EXPECT_THAT(doubt(60, 0), HasSubstr("{encoding} rg16"));
  EXPECT_THAT(doubt(255, 255), AllOf(HasSubstr("red is 255 and blue 255"), HasSubstr("{normals}")));
}

TEST_F(HeightChannels, GreyWithAlphaAndPlainGreenRaiseNoDoubt) {
  const auto doubt = [&](const std::function<double(int, int)>& side,
                         const std::function<double(int, int)>& alpha) {
    write("p.png", {"R", "G", "B", "A"}, [&](int x, int y) {
      return Doubles{side(x, y), relief(x, y), side(x, y), alpha(x, y)};
    });
    return read("p.png").doubt;
  };
  const auto none = [](int, int) { return 0.0; };
  for (const double constant : {0.2, 0.5, 1.0}) {
    EXPECT_EQ(doubt(relief, [&](int, int) { return constant; }), "") << constant;
    EXPECT_EQ(doubt(none, [&](int, int) { return constant; }), "") << constant;
  }
  const auto mask = [](int x, int y) { return std::hypot(x - 32, y - 32) < 30 ? 1.0 : 0.0; };
  const auto soft = [](int x, int y) { return std::clamp((40 - std::hypot(x - 32, y - 32)) / 16, 0.0, 1.0); };
  EXPECT_EQ(doubt(relief, mask), "");
  EXPECT_EQ(doubt(none, mask), "");
  EXPECT_EQ(doubt(relief, soft), "");
}

// ---- Split encodings

// Splits a number of 24 bits.
Doubles split24(int64_t value) {
  return {static_cast<double>(value >> 16) / 255, static_cast<double>(value >> 8 & 255) / 255,
          static_cast<double>(value & 255) / 255};
}

Doubles terrarium(double metres) { return split24(std::llround((metres + 32768) * 256)); }
Doubles mapbox(double metres) { return split24(std::llround((metres + 10000) * 10)); }

TEST_F(HeightChannels, TilesAreMetres) {
  for (const double low : {-9500.0, -400.0, 0.0, 100.0, 5000.0}) {
    for (const double range : {50.0, 800.0, 3800.0}) {
      const auto metres = [&](int x, int y) { return std::max(-9999.0, low + range * relief(x, y)); };
      write("terrarium.png", {"R", "G", "B"}, [&](int x, int y) { return terrarium(metres(x, y)); });
      write("mapbox.png", {"R", "G", "B"}, [&](int x, int y) { return mapbox(metres(x, y)); });
      const HeightFile t = read("terrarium.png", encoding(SplitEncoding::kTerrarium));
      const HeightFile m = read("mapbox.png", encoding(SplitEncoding::kMapbox));
      EXPECT_TRUE(t.in_metres && m.in_metres);
      EXPECT_EQ(t.full_scale, 1);
      EXPECT_EQ(t.channel, "terrarium");
      EXPECT_EQ(m.channel, "mapbox");
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          ASSERT_NEAR(t.values(x, y), metres(x, y), 0.5001 / 256 + 1e-3);
          ASSERT_NEAR(m.values(x, y), metres(x, y), 0.05 + 1e-3);
        }
      EXPECT_THAT(fault("terrarium.png"), HasSubstr("--")) << low << " " << range;
      EXPECT_THAT(fault("mapbox.png"), HasSubstr("--")) << low << " " << range;
      if (low >= 0) {
        EXPECT_THAT(fault("terrarium.png"), HasSubstr("--encoding terrarium,")) << low << " " << range;
        EXPECT_THAT(fault("mapbox.png"), HasSubstr("--encoding mapbox,")) << low << " " << range;
      }
    }
  }
}

TEST_F(HeightChannels, SixteenBitsInRedAndGreen) {
  for (const double amplitude : {0.01, 0.1, 1.0}) {
    const auto value = [&](int x, int y) { return std::lround(65535 * amplitude * relief(x, y)); };
    const auto texel = [&](int x, int y) {
      return Doubles{static_cast<double>(value(x, y) >> 8) / 255,
                     static_cast<double>(value(x, y) & 255) / 255, 0.0};
    };
    write("rg.png", {"R", "G", "B"}, texel);
    EXPECT_THAT(fault("rg.png"), HasSubstr("looks like heights split over channels of 8 bits, expected "
                                           "--encoding rg16"))
        << amplitude;
    const HeightFile file = read("rg.png", encoding(SplitEncoding::kRg16));
    EXPECT_EQ(file.full_scale, 65535);
    EXPECT_FALSE(file.in_metres);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        ASSERT_EQ(file.values(x, y), static_cast<float>(static_cast<double>(value(x, y)) / 65535));
  }
}

TEST_F(HeightChannels, EncodingsNeedTheirChannels) {
  write<uint16_t>("16.png", {"R", "G", "B"}, [](int x, int y) { return Doubles(3, relief(x, y)); });
  EXPECT_THAT(
      fault("16.png", encoding(SplitEncoding::kTerrarium)),
      EndsWith("16.png: holds 16-bit integers in 3 channel(s), expected red, green and blue of 8 bits "
               "for --encoding terrarium"));
  write("y.png", {"Y"}, [](int x, int y) { return Doubles{relief(x, y)}; });
  EXPECT_THAT(fault("y.png", encoding(SplitEncoding::kRg16)), HasSubstr("red, green of 8 bits"));
  write("rgb.png", {"R", "G", "B"}, [](int x, int y) { return Doubles(3, relief(x, y)); });
  HeightFileOptions both = encoding(SplitEncoding::kMapbox);
  both.channel = "R";
  EXPECT_THAT(fault("rgb.png", both), HasSubstr("expected no --channel"));
}

TEST_F(HeightChannels, TransparentTileTexelsAreHoles) {
  write("t.png", {"R", "G", "B", "A"}, [](int x, int y) {
    Doubles texel = terrarium(100 * relief(x, y));
    texel.push_back(x == 3 ? 0 : 1);
    return texel;
  });
  const HeightFile file = read("t.png", encoding(SplitEncoding::kTerrarium));
  EXPECT_EQ(file.holes(3, 9), 1);
  EXPECT_EQ(file.holes(4, 9), 0);
  EXPECT_EQ(file.values(3, 9), 0);
}

}  // namespace
}  // namespace hemibake
