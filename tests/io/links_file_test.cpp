#include "io/links_file.h"

#include <gmock/gmock.h>
#include <hdf5.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include "core/context.h"
#include "io/io_testing.h"
#include "io/links_layout.h"

// For the sanitizer build: HDF5 never frees a file that it could not flush.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace hemibake {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

// Rows of 0 to 8 links; several blocks where rows > FormFactorMatrix::kRowsPerBlock.
FormFactorMatrix random_links(uint32_t rows, uint32_t columns, unsigned seed) {
  std::mt19937 random(seed);
  FormFactorMatrix links = make_form_factors(rows, columns);
  for (uint32_t row = 0; row < rows; ++row) {
    std::vector<FormFactor> entries;
    for (uint32_t patch = random() % 7; patch < columns && entries.size() < random() % 9;
         patch += 1 + random() % 50)
      entries.push_back({patch, static_cast<float>(1 + random() % 65535) / 65536});
    append_row(links.blocks[row / FormFactorMatrix::kRowsPerBlock], entries);
  }
  finish_blocks(links);
  return links;
}

std::vector<float> some_direct(size_t count) {
  std::vector<float> direct(count);
  for (size_t i = 0; i < count; ++i) direct[i] = static_cast<float>(i) * 0.001f;
  return direct;
}

Provenance sample_provenance() {
  return {{"version", "0"},     {"command", "hemibake bake ü.png"},
          {"rays", 256},        {"seed", std::numeric_limits<uint64_t>::max()},
          {"offset", -3},       {"size_m", 0.25},
          {"converged", false}, {"long", std::string(100000, 'x')}};
}

void expect_same_links(const FormFactorMatrix& a, const FormFactorMatrix& b) {
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.columns, b.columns);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  uint32_t rounded_again = 0;
  for (size_t i = 0; i < a.blocks.size(); ++i) {
    BlockRows rows_a, rows_b;
    unpack_block(a.blocks[i], rows_a);
    unpack_block(b.blocks[i], rows_b);
    EXPECT_EQ(rows_a.row_begin, rows_b.row_begin);
    EXPECT_EQ(rows_a.columns, rows_b.columns);
    // Packed again most rows are multiples of what they were multiples of, within 10⁻⁴ of it; few that lost
    // links are rounded again, by less than a twelfth of their mean weight (links_pack.cpp).
    ASSERT_EQ(rows_a.weights.size(), rows_b.weights.size());
    for (size_t row = 0; row + 1 < rows_a.row_begin.size(); ++row) {
      const size_t begin = rows_a.row_begin[row], end = rows_a.row_begin[row + 1];
      const float sum = std::accumulate(rows_a.weights.begin() + static_cast<std::ptrdiff_t>(begin),
                                        rows_a.weights.begin() + static_cast<std::ptrdiff_t>(end), 0.0f);
      bool same = true;
      for (size_t k = begin; k < end; ++k) {
        same = same && std::abs(rows_a.weights[k] - rows_b.weights[k]) < 1e-4f * rows_a.weights[k];
        EXPECT_NEAR(rows_a.weights[k], rows_b.weights[k], sum / (12 * static_cast<float>(end - begin)));
      }
      rounded_again += !same;
    }
  }
  EXPECT_LE(rounded_again, a.rows / 500);
}

TEST(LinksFile, RoundTripOverSeveralBlocks) {
  const TemporaryFolder folder;
  const FormFactorMatrix final_gather = random_links(2500, 5000, 1);
  const FormFactorMatrix patches = random_links(5000, 5000, 2);
  write_links(folder / "links.h5", final_gather, &patches, some_direct(5000), sample_provenance());
  const LinksFile read = read_links(folder / "links.h5");
  expect_same_links(read.final_gather, final_gather);
  ASSERT_TRUE(read.patch_form_factors.has_value());
  expect_same_links(*read.patch_form_factors, patches);
  EXPECT_EQ(read.direct, some_direct(5000));
  EXPECT_EQ(read.provenance.dump(), sample_provenance().dump());
  EXPECT_EQ(folder.count(), 1u);
}

TEST(LinksFile, OneMatrixIsStoredOnce) {
  const TemporaryFolder folder;
  const FormFactorMatrix final_gather = random_links(3000, 3000, 1);
  write_links(folder / "one.h5", final_gather, nullptr, some_direct(3000), {{"version", "0"}});
  write_links(folder / "two.h5", final_gather, &final_gather, some_direct(3000), {{"version", "0"}});
  const LinksFile read = read_links(folder / "one.h5");
  EXPECT_FALSE(read.patch_form_factors.has_value());
  expect_same_links(read.final_gather, final_gather);
  const auto size = [&](const char* name) { return std::filesystem::file_size(folder / name); };
  EXPECT_LT(static_cast<double>(size("one.h5")), 0.6 * static_cast<double>(size("two.h5")));
}

TEST(LinksFile, NoLinksAtAll) {
  const TemporaryFolder folder;
  FormFactorMatrix flat = make_form_factors(4, 4);
  for (int row = 0; row < 4; ++row) append_row(flat.blocks[0], {});
  finish_blocks(flat);
  write_links(folder / "flat.h5", flat, nullptr, some_direct(4), {{"version", "0"}});
  expect_same_links(read_links(folder / "flat.h5").final_gather, flat);
}

TEST(LinksFile, SameBytesEverySecond) {
  const TemporaryFolder folder;
  const FormFactorMatrix final_gather = random_links(1500, 1500, 1);
  write_links(folder / "a.h5", final_gather, nullptr, some_direct(1500), sample_provenance());
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // times in HDF5 are whole seconds
  write_links(folder / "b.h5", final_gather, nullptr, some_direct(1500), sample_provenance());
  EXPECT_EQ(read_bytes(folder / "a.h5"), read_bytes(folder / "b.h5"));
}

TEST(LinksFile, WrongUseIsABug) {
  const TemporaryFolder folder;
  FormFactorMatrix final_gather = random_links(1500, 3000, 1);
  const auto bug = [&](const std::vector<float>& direct) {
    return error_of<std::logic_error>([&] {
      const FormFactorMatrix patches = random_links(3000, 3000, 2);
      write_links(folder / "links.h5", final_gather, &patches, direct, {{"version", "0"}});
    });
  };
  EXPECT_THAT(bug(some_direct(2999)), HasSubstr("values of direct is 2999, expected 3000"));
  std::vector<float> infinite = some_direct(3000);
  infinite[7] = INFINITY;
  EXPECT_THAT(bug(infinite), HasSubstr("E0 of a patch is inf"));
  --final_gather.blocks[1].rows;
  EXPECT_THAT(bug(some_direct(3000)), HasSubstr("rows of gather is 1499, expected 1500"));
  EXPECT_THROW(
      write_links(folder / "links.h5", random_links(3, 4, 1), nullptr, some_direct(4), {{"version", "0"}}),
      std::logic_error);
  EXPECT_EQ(folder.count(), 0u);
}

TEST(LinksFile, RefusesWhatIsNoLinksFile) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& name) {
    return error_of<InputError>([&] { read_links(folder / name); });
  };
  EXPECT_THAT(refusal("missing.h5"), HasSubstr("missing.h5: No such file or directory, expected"));
  EXPECT_THAT(refusal(""), HasSubstr("is not a regular file"));
  write_bytes(folder / "empty.h5", "");
  EXPECT_THAT(refusal("empty.h5"), HasSubstr("empty.h5: is not a whole links file"));
  write_bytes(folder / "text.h5", "no HDF5 at all");
  EXPECT_THAT(refusal("text.h5"), HasSubstr("is not a whole links file"));
  H5Fclose(H5Fcreate((folder / "other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_THAT(refusal("other.h5"), HasSubstr("other.h5: is HDF5 of another program or an older version"));
}

TEST(LinksFile, CutShortAnywhereIsRefused) {
  const TemporaryFolder folder;
  write_links(folder / "links.h5", random_links(1500, 1500, 1), nullptr, some_direct(1500),
              {{"version", "0"}});
  const std::string bytes = read_bytes(folder / "links.h5");
  for (const size_t length : {size_t{1}, size_t{100}, size_t{1000}, bytes.size() / 2, bytes.size() - 1}) {
    write_bytes(folder / "cut.h5", bytes.substr(0, length));
    EXPECT_THAT(error_of<InputError>([&] { read_links(folder / "cut.h5"); }),
                HasSubstr("cut.h5: is not a whole"));
  }
}

// A good file in which `change` has overwritten something.
class DamagedLinks : public testing::Test {
 protected:
  std::string refusal_after(const std::function<void(hid_t)>& change) {
    const auto path = write_good();
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    change(file);
    H5Fclose(file);
    return error_of<InputError>([&] { read_links(path); });
  }
  std::filesystem::path write_good() {
    FormFactorMatrix final_gather = make_form_factors(3, 3);
    append_row(final_gather.blocks[0], std::vector<FormFactor>{{1, 0.25f}, {2, 0.5f}});
    append_row(final_gather.blocks[0], {});
    append_row(final_gather.blocks[0], std::vector<FormFactor>{{0, 0.125f}});
    finish_blocks(final_gather);
    auto path = folder_ / "links.h5";
    write_links(path, final_gather, nullptr, some_direct(3), {{"version", "0"}});
    return path;
  }
  template <class Number>
  static void overwrite(hid_t file, const char* name, hid_t type, const std::vector<Number>& values) {
    const hid_t data = H5Dopen2(file, name, H5P_DEFAULT);
    H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(data);
  }

  TemporaryFolder folder_;
};

TEST_F(DamagedLinks, RowBegins) {
  const auto refusal = [&](const std::vector<uint64_t>& begins) {
    return refusal_after([&](hid_t file) { overwrite(file, "gather/indptr", H5T_NATIVE_UINT64, begins); });
  };
  EXPECT_THAT(refusal({0, 2, 1, 3}), HasSubstr("row 1 of gather goes from link 2 to 1 of 3"));
  EXPECT_THAT(refusal({1, 2, 2, 3}), HasSubstr("first row of gather begins at link 1"));
  EXPECT_THAT(refusal({0, 2, 2, 4}), HasSubstr("row 2 of gather goes from link 2 to 4 of 3"));
  EXPECT_THAT(refusal({0, 1, 2, 2}), HasSubstr("last row of gather ends at link 2 of 3"));
  EXPECT_THAT(refusal({0, UINT64_MAX, UINT64_MAX, 3}), HasSubstr("row 0 of gather"));
}

TEST_F(DamagedLinks, Values) {
  EXPECT_THAT(refusal_after([](hid_t file) {
                overwrite<uint32_t>(file, "gather/indices", H5T_NATIVE_UINT32, {1, 3, 0});
              }),
              HasSubstr("a link of gather goes to patch 3 of 3"));
  EXPECT_THAT(refusal_after([](hid_t file) {
                overwrite<float>(file, "gather/weights", H5T_NATIVE_FLOAT, {0.1f, NAN, 0});
              }),
              HasSubstr("a weight of gather is nan"));
  EXPECT_THAT(refusal_after([](hid_t file) {
                overwrite<float>(file, "gather/weights", H5T_NATIVE_FLOAT, {0.1f, 0.2f, -0.5f});
              }),
              HasSubstr("a weight of gather is -0.5"));
  EXPECT_THAT(refusal_after([](hid_t file) {
                overwrite<uint32_t>(file, "gather/indices", H5T_NATIVE_UINT32, {2, 2, 0});
              }),
              HasSubstr("in row 0 of gather patch 2 follows patch 2"));
  EXPECT_THAT(refusal_after([](hid_t file) {
                overwrite<float>(file, "direct", H5T_NATIVE_FLOAT, {0, 0, INFINITY});
              }),
              HasSubstr("direct of patch 2 is inf"));
}

TEST_F(DamagedLinks, OtherValues) {
  EXPECT_THAT(refusal_after([](hid_t file) {
                overwrite<float>(file, "gather/weights", H5T_NATIVE_FLOAT, {0.25f, 0.25f, 0.25f});
              }),
              HasSubstr("links.h5: is not a whole links file (gather/weights was changed)"));
  EXPECT_THAT(refusal_after([](hid_t file) {
                overwrite<float>(file, "direct", H5T_NATIVE_FLOAT, {0, 0, 3});
              }),
              HasSubstr("direct was changed"));
}

// A head that was made for these words, whatever they are: its hash is right.
TEST_F(DamagedLinks, Head) {
  const auto path = write_good();
  const std::string good = read_bytes(path);
  constexpr uint64_t kHeadBytes = 4096;
  ASSERT_EQ(good.substr(kHeadBytes, 4), "\x89HDF");
  const auto refusal = [&](const std::function<void(LinksLayout&)>& change) {
    write_bytes(path, good);
    LinksLayout layout = read_links_layout(path);
    change(layout);
    write_bytes(path, links_head(layout, kHeadBytes) + good.substr(kHeadBytes));
    return error_of<InputError>([&] { read_links(path); });
  };
  EXPECT_THAT(refusal([](LinksLayout& layout) { layout.gather.rows = 4; }),
              HasSubstr("its head: gather has 4 rows, 4 row starts"));
  EXPECT_THAT(refusal([](LinksLayout& layout) { layout.gather.columns = 4; }),
              HasSubstr("the patches do not agree"));
  EXPECT_THAT(refusal([](LinksLayout& layout) { layout.gather.rows = UINT32_MAX; }),
              HasSubstr("expected a whole"));
  EXPECT_THAT(refusal([](LinksLayout& layout) { layout.direct.count = uint64_t{1} << 40; }),
              HasSubstr("direct/count is 1099511627776, expected"));
  EXPECT_THAT(refusal([](LinksLayout& layout) { layout.gather.weights.offset = UINT64_MAX - 3; }),
              HasSubstr("gather/weights/offset is "));
  EXPECT_THAT(refusal([](LinksLayout& layout) { layout.gather.indices.count = 2; }),
              HasSubstr("2 indices and 3"));
  EXPECT_THAT(refusal([](LinksLayout& layout) { layout.file_bytes += 1; }), HasSubstr("bytes is "));
  EXPECT_THAT(refusal([](LinksLayout& layout) { layout.direct.offset -= 4; }),
              HasSubstr("direct was changed"));
  EXPECT_THAT(refusal([](LinksLayout& layout) {
                layout.provenance = {{"version", 5}};
              }),
              HasSubstr("provenance/version is 5, expected a text"));
}

TEST_F(DamagedLinks, AnyBytes) {
  const auto path = write_good();
  const std::string good = read_bytes(path);
  std::mt19937 random(18);
  int taken = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string bytes = good;
    // Half of them in the head and what follows it, where everything stands that is read.
    const size_t reach = i % 2 == 0 ? bytes.size() : 400;
    for (unsigned k = 0; k <= random() % 8; ++k) bytes[random() % reach] = static_cast<char>(random());
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    write_bytes(path, bytes);
    try {
      read_links(path);
      ++taken;
    } catch (const InputError&) {
    }
  }
  EXPECT_LT(taken, 2500);  // where only the HDF5 around the arrays was hit
}

void write_too_much(const std::filesystem::path& path) {
  write_links(path, random_links(100000, 100000, 1), nullptr, some_direct(100000), {{"version", "0"}});
}

TEST(LinksFile, FullDiskIsOneLineAndLeavesNothing) {
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a disk";
  EXPECT_THAT(error_of<InputError>([&] { write_too_much(disk / "links.h5"); }),
              EndsWith("links.h5: could not write: No space left on device"));
  EXPECT_EQ(disk.count(), 0u);
}

// In a child process: signal handlers and limits stay.
[[noreturn]] void write_under_size_limits() {
  std::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t limit : {200, 3000, 20000, 100000}) {
    const TemporaryFolder folder;
    const rlimit size{limit, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &size);
    const std::string text = error_of<InputError>([&] { write_too_much(folder / "links.h5"); });
    if (text.ends_with("could not write: File too large") && folder.count() == 0) continue;
    std::fprintf(stderr, "limit %d: %s\n", static_cast<int>(limit), text.c_str());
    std::exit(1);
  }
  std::exit(0);
}

TEST(LinksFileDeathTest, FileSizeLimit) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(write_under_size_limits(), testing::ExitedWithCode(0), "");
}

TEST(LinksFile, OpensInSciPy) {
  constexpr const char* kPython = "/usr/bin/python3";
  if (std::system((std::string(kPython) + " -c 'import h5py, scipy.sparse' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "python3 with h5py and scipy is not there";
  const TemporaryFolder folder;
  const FormFactorMatrix final_gather = random_links(2000, 2000, 3);
  write_links(folder / "links.h5", final_gather, nullptr, some_direct(2000), sample_provenance());
  std::vector<double> sums = row_sums(final_gather);
  double expected = 0;
  for (size_t i = 0; i < sums.size(); ++i) expected += sums[i] * static_cast<double>(i + 1);
  write_bytes(folder / "read.py", R"(
import sys, h5py, numpy, scipy.sparse
f = h5py.File(sys.argv[1])
g = f["patches"]
m = scipy.sparse.csr_matrix((g["weights"], g["indices"], g["indptr"]), shape=tuple(g.attrs["shape"]))
m.check_format()
assert g["weights"].dtype == numpy.float32 and g["indices"].dtype == numpy.uint32 and g["indptr"].dtype == numpy.uint64
assert m.shape == (2000, 2000) and f["direct"].shape == (2000,) and f["direct"].dtype == numpy.float32
assert f["gather"] == f["patches"]
total = numpy.arange(1, 2001) @ (m.astype(float) @ numpy.ones(2000))
assert abs(total - float(sys.argv[2])) < 1e-9 * total, total
a = f.attrs
assert a["hemibake:version"] == "0" and a["hemibake:command"] == "hemibake bake ü.png" and a["hemibake:offset"] == -3
assert int(a["hemibake:seed"]) == 2**64 - 1 and a["hemibake:size_m"] == 0.25 and a["hemibake:converged"] == 0
)");
  const std::string command = std::string(kPython) + " " + (folder / "read.py").string() + " " +
                              (folder / "links.h5").string() + " " + std::to_string(expected);
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace hemibake
