#include "io/bake_file.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "core/parallel.h"
#include "io/image_io.h"
#include "io/io_testing.h"
#include "support/threads.h"

namespace hemibake {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

Grid<float> random_plane(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Grid<float> plane(width, height);
  for (float& value : plane.values) value = static_cast<float>(random()) / 4.3e9f;
  return plane;
}

Grid<glm::vec3> random_vectors(int width, int height, unsigned seed) {
  Grid<glm::vec3> plane(width, height);
  const Grid<float> values = random_plane(width * 3, height, seed);
  std::memcpy(&plane.values[0].x, values.values.data(), values.size() * sizeof(float));
  for (glm::vec3& vector : plane.values) vector = glm::normalize(vector + 0.01f);
  return plane;
}

Bake random_bake(int width, int height, int bounces) {
  Bake bake;
  bake.width = width;
  bake.height = height;
  bake.visible_fraction = random_plane(width, height, 1);
  for (int b = 0; b < bounces; ++b)
    bake.irradiance.push_back(random_plane(width, height, 100 + static_cast<unsigned>(b)));
  bake.total = random_plane(width, height, 2);
  bake.residual = random_plane(width, height, 3);
  bake.normals = random_vectors(width, height, 4);
  bake.bent_normals = random_vectors(width, height, 5);
  return bake;
}

Provenance sample_provenance() {
  return {{"version", "0.1.0"},
          {"command", "hemibake bake 'a b.png'"},
          {"rays", 256},
          {"seed", std::numeric_limits<uint64_t>::max()},
          {"links", int64_t{1} << 40},
          {"below", std::numeric_limits<int64_t>::min()},
          {"size_m", 0.1},
          {"whole_m", 1.0},
          {"wrap", true},
          {"digits", "12345678901"},
          {"empty", ""}};
}

void expect_same_bits(const Grid<float>& a, const Grid<float>& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  EXPECT_EQ(std::memcmp(a.values.data(), b.values.data(), a.size() * sizeof(float)), 0);
}

TEST(BakeFile, RoundTripIsBitExact) {
  const TemporaryFolder folder;
  Bake bake = random_bake(37, 301, 21);
  bake.total[5] = -0.0f;
  bake.total[6] = std::numeric_limits<float>::denorm_min();
  bake.total[7] = 3.1415927f;
  write_bake(folder / "bake.exr", bake, sample_provenance());
  const BakeFile read = read_bake(folder / "bake.exr");
  expect_same_bits(read.bake.visible_fraction, bake.visible_fraction);
  ASSERT_EQ(read.bake.irradiance.size(), 21u);
  for (size_t b = 0; b < 21; ++b) expect_same_bits(read.bake.irradiance[b], bake.irradiance[b]);
  expect_same_bits(read.bake.total, bake.total);
  expect_same_bits(read.bake.residual, bake.residual);
  EXPECT_EQ(read.bake.normals.values, bake.normals.values);
  EXPECT_EQ(read.bake.bent_normals.values, bake.bent_normals.values);
  EXPECT_EQ(read.provenance.dump(), sample_provenance().dump());
  EXPECT_EQ(read.provenance["seed"].get<uint64_t>(), std::numeric_limits<uint64_t>::max());
  EXPECT_EQ(folder.count(), 1u);
}

TEST(BakeFile, AbsentPlanesStayAbsent) {
  const TemporaryFolder folder;
  Bake bake;
  bake.width = 1;
  bake.height = 1;
  bake.visible_fraction = Grid<float>(1, 1, 0.5f);
  write_bake(folder / "bake.exr", bake, {{"version", "0"}});
  EXPECT_EQ(read_image_header(folder / "bake.exr").channels, std::vector<std::string>{"ao"});
  const Bake read = read_bake(folder / "bake.exr").bake;
  EXPECT_EQ(read.visible_fraction[0], 0.5f);
  EXPECT_TRUE(read.irradiance.empty());
  EXPECT_TRUE(read.total.empty() && read.residual.empty() && read.normals.empty() &&
              read.bent_normals.empty());
}

TEST(BakeFile, MoreThanAHundredBounces) {
  const TemporaryFolder folder;
  Bake bake;
  bake.width = 2;
  bake.height = 1;
  for (int b = 0; b < 120; ++b) bake.irradiance.emplace_back(2, 1, static_cast<float>(b) / 64);
  write_bake(folder / "bake.exr", bake, {{"version", "0"}});
  const Bake read = read_bake(folder / "bake.exr").bake;
  ASSERT_EQ(read.irradiance.size(), 120u);
  for (int b = 0; b < 120; ++b)
    EXPECT_EQ(read.irradiance[static_cast<size_t>(b)][1], static_cast<float>(b) / 64);
}

TEST(BakeFile, SameBytesEveryTimeAtAnyThreadCount) {
  const TemporaryFolder folder;
  const Bake bake = random_bake(200, 300, 4);
  set_thread_count(1);
  write_bake(folder / "a.exr", bake, sample_provenance());
  set_thread_count(2);
  write_bake(folder / "b.exr", bake, sample_provenance());
  set_thread_count(0);
  EXPECT_EQ(read_bytes(folder / "a.exr"), read_bytes(folder / "b.exr"));
  // The same a second later, too: the date of writing is left empty.
  using namespace std::string_literals;
  EXPECT_THAT(read_bytes(folder / "a.exr"), HasSubstr("capDate\0string\0\0\0\0\0"s));
}

TEST(BakeFile, NanIsABugThatNamesChannelAndTexel) {
  const TemporaryFolder folder;
  Bake bake = random_bake(10, 20, 3);
  bake.irradiance[1](4, 17) = std::nanf("");
  EXPECT_THAT(error_of<std::logic_error>([&] {
                write_bake(folder / "bake.exr", bake, {{"version", "0"}});
              }),
              HasSubstr("bake.exr: channel irradiance.01 is nan at texel 4,17, expected a finite number"));
  bake.irradiance[1](4, 17) = 0;
  bake.bent_normals(9, 19).z = INFINITY;
  EXPECT_THAT(error_of<std::logic_error>([&] {
                write_bake(folder / "bake.exr", bake, {{"version", "0"}});
              }),
              HasSubstr("channel bent.Z"));
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BakeFile, WrongUseIsABug) {
  const TemporaryFolder folder;
  Bake bake = random_bake(10, 20, 1);
  bake.total = Grid<float>(20, 10);
  EXPECT_THAT(error_of<std::logic_error>([&] {
                write_bake(folder / "bake.exr", bake, {{"version", "0"}});
              }),
              HasSubstr("width of plane total of a bake is 20, expected 10"));
  EXPECT_THROW(write_bake(folder / "bake.exr", Bake{}, {{"version", "0"}}), std::logic_error);
  bake.total = {};
  EXPECT_THROW(write_bake(folder / "bake.exr", bake, {{"seconds", std::nan("")}}), std::logic_error);
  EXPECT_THROW(write_bake(folder / "bake.exr", bake, {{"list", {1, 2}}}), std::logic_error);
  EXPECT_THROW(write_bake(folder / "bake.exr", bake, {{"provenance", "x"}}), std::logic_error);
  EXPECT_THROW(write_bake(folder / "bake.exr", bake, nullptr), std::logic_error);
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BakeFile, RefusesWhatIsNoBake) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& name) {
    return error_of<InputError>([&] { read_bake(folder / name); });
  };
  EXPECT_THAT(refusal("missing.exr"), EndsWith("missing.exr: No such file or directory, expected an image"));
  write_height_map(folder / "map.exr", Grid<float>(4, 4), Provenance::object());
  EXPECT_THAT(refusal("map.exr"), HasSubstr("map.exr: has no hemibake attributes, expected"));
  write_height_map(folder / "synth.exr", Grid<float>(4, 4), {{"version", "0"}});
  EXPECT_THAT(refusal("synth.exr"), HasSubstr("synth.exr: holds none of the channels of a bake"));
  write_bytes(folder / "text.exr", "bin,ao\n1,2\n");
  EXPECT_THAT(refusal("text.exr"), HasSubstr("text.exr: is not an image"));
  EXPECT_THROW(write_bake(folder / "bake.png", random_bake(2, 2, 1), {{"version", "0"}}), InputError);
}

TEST(BakeFile, RefusesGapsAndHalves) {
  const TemporaryFolder folder;
  const std::vector<float> zeros(4);
  const auto refusal = [&](const std::vector<std::string>& channels) {
    std::vector<Plane> planes;
    for (const std::string& channel : channels) planes.push_back({channel, zeros.data()});
    write_image(folder / "gap.exr", 2, 2, planes, {{"version", "0"}});
    return error_of<InputError>([&] { read_bake(folder / "gap.exr"); });
  };
  EXPECT_THAT(refusal({"irradiance.00", "irradiance.02"}), HasSubstr("has no channel 'irradiance.01'"));
  EXPECT_THAT(refusal({"ao", "bent.X", "bent.Y"}), HasSubstr("has no channel 'bent.Z'"));
}

TEST(BakeFile, ValuesOutOfTheirRangeAreNamed) {
  const TemporaryFolder folder;
  const auto write = [&](const std::function<void(Bake&)>& change, const Provenance& provenance) {
    Bake bake = random_bake(8, 6, 2);
    bake.visibility = random_plane(8, 6, 9);
    change(bake);
    write_bake(folder / "odd.exr", bake, provenance);
  };
  const auto refusal = [&](const std::function<void(Bake&)>& change) {
    write(change, {{"version", "0"}});
    return error_of<InputError>([&] { read_bake(folder / "odd.exr"); });
  };
  EXPECT_THAT(refusal([](Bake& bake) { bake.visible_fraction(3, 2) = -5; }),
              HasSubstr("odd.exr: channel ao is -5 at texel 3,2, expected -0.001 to 1.001"));
  EXPECT_THAT(refusal([](Bake& bake) { bake.visibility(7, 5) = 1.5f; }),
              HasSubstr("channel visibility is 1.5 at texel 7,5"));
  const std::function<void(Bake&)> brighten = [](Bake& bake) { bake.irradiance[1](0, 1) = 3.2f; };
  EXPECT_THAT(refusal(brighten), HasSubstr("channel irradiance.01 is 3.2 at texel 0,1"));
  EXPECT_THAT(refusal([](Bake& bake) { bake.total[0] = -1; }), HasSubstr("channel total is -1"));
  EXPECT_THAT(refusal([](Bake& bake) { bake.residual[0] = 2; }), HasSubstr("channel residual is 2"));
  EXPECT_THAT(refusal([](Bake& bake) {
                bake.normals[4] = {0, 0, 2};
              }),
              HasSubstr("channel normal has length 2"));
  EXPECT_THAT(refusal([](Bake& bake) { bake.normals[4] *= 0; }), HasSubstr("channel normal has length 0"));
  EXPECT_THAT(refusal([](Bake& bake) {
                bake.bent_normals[4] = {0, 0, 2};
              }),
              HasSubstr("channel bent has length 2"));

  write([](Bake& bake) { bake.bent_normals[4] = glm::vec3(0); }, {{"version", "0"}});
  read_bake(folder / "odd.exr");  // a texel that sees no sky
  write(brighten, {{"version", "0"}, {"normalize", "published"}});
  EXPECT_EQ(read_bake(folder / "odd.exr").bake.irradiance[1](0, 1), 3.2f);
}

TEST(BakeFile, AttributesThatAreNoneAreNamed) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    const std::string path = (folder / "odd.exr").string();
    const std::vector<float> texels(4, 0.5f);
    OIIO::ImageSpec spec(2, 2, 1, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"ao"};
    spec.attribute("hemibake:provenance", text);
    const auto output = OIIO::ImageOutput::create(path);
    EXPECT_TRUE(output && output->open(path, spec) &&
                output->write_image(OIIO::TypeDesc::FLOAT, texels.data()) && output->close());
    return error_of<InputError>([&] { read_bake(path); });
  };
  const std::string at = "odd.exr: attribute hemibake:provenance";
  EXPECT_THAT(refusal(R"({"input": 5})"), HasSubstr(at + ": input is 5, expected a text"));
  EXPECT_THAT(refusal(R"({"rays": [5]})"),
              HasSubstr(at + ": rays is a list of 1, expected a text, a number"));
  EXPECT_THAT(refusal(R"({"rays": )"), HasSubstr(at + ": line 1, column "));
  EXPECT_THAT(refusal("[]"), HasSubstr(at + " is a list of 0, expected an object"));
  EXPECT_THAT(refusal("{\"a\":" + std::string(100000, '[') + std::string(100000, ']') + "}"),
              HasSubstr(at + ": nests deeper than 64"));
}

// Sizes of attributes in the header that the file does not have.
TEST(BakeFile, AttributesOfWrongSizesAreRefused) {
  const TemporaryFolder folder;
  write_bake(folder / "bake.exr", random_bake(8, 8, 1), sample_provenance());
  const std::string whole = read_bytes(folder / "bake.exr");
  using namespace std::string_literals;
  for (const std::string& name :
       {"channels\0chlist\0"s, "compression\0compression\0"s, "dataWindow\0box2i\0"s,
        "hemibake:provenance\0string\0"s, "lineOrder\0lineOrder\0"s})
    for (const int32_t size :
         {-1, 1 << 20, std::numeric_limits<int32_t>::max(), std::numeric_limits<int32_t>::min()}) {
      std::string bytes = whole;
      const size_t at = bytes.find(name);
      ASSERT_NE(at, std::string::npos) << name;
      std::memcpy(&bytes[at + name.size()], &size, sizeof(size));
      write_bytes(folder / "odd.exr", bytes);
      EXPECT_THAT(error_of<InputError>([&] { read_bake(folder / "odd.exr"); }), HasSubstr("odd.exr: is "))
          << name << size;
    }
}

TEST(BakeFile, CutShortAnywhereIsRefused) {
  const TemporaryFolder folder;
  write_bake(folder / "bake.exr", random_bake(64, 64, 3), sample_provenance());
  const std::string bytes = read_bytes(folder / "bake.exr");
  for (const double part : {0.0, 0.0001, 0.001, 0.01, 0.1, 0.5, 0.9, 0.999, 0.99999}) {
    write_bytes(folder / "cut.exr",
                bytes.substr(0, static_cast<size_t>(part * static_cast<double>(bytes.size()))));
    EXPECT_THAT(error_of<InputError>([&] { read_bake(folder / "cut.exr"); }), HasSubstr("cut.exr: ")) << part;
  }
}

}  // namespace
}  // namespace hemibake
