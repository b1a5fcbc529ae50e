#include "io/table_io.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "io/io_testing.h"

namespace hemibake {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using Row = std::vector<std::optional<double>>;

class Csv : public testing::Test {
 protected:
  Table read(const std::string& text) {
    write_bytes(path_, text);
    return read_csv(path_);
  }
  std::string refusal(const std::string& text) {
    return error_of<InputError>([&] { read(text); });
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "t.csv";
};

TEST_F(Csv, RoundTripIsExactAndShort) {
  const Table table{{"bin", "E00_mean"},
                    {{0, 0.1},
                     {1e6, std::nullopt},
                     {std::nullopt, std::nullopt},
                     {-0.0, 1.0 / 3.0},
                     {std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min()},
                     {262144, 5e-324}}};
  write_csv(path_, table);
  EXPECT_THAT(read_bytes(path_),
              testing::StartsWith("bin,E00_mean\n0,0.1\n1000000,\n,\n-0,0.3333333333333333\n"));
  const Table back = read_csv(path_);
  EXPECT_EQ(back.columns, table.columns);
  EXPECT_EQ(back.rows, table.rows);
  EXPECT_TRUE(std::signbit(*back.rows[3][0]));
}

TEST_F(Csv, LineEnds) {
  for (const char* text : {"a,b\n1,2\n", "a,b\n1,2", "a,b\r\n1,2\r\n",
                           "\xEF\xBB\xBF"
                           "a,b\n1,2\n"}) {
    const Table table = read(text);
    EXPECT_THAT(table.columns, ElementsAre("a", "b"));
    EXPECT_THAT(table.rows, ElementsAre(Row{1, 2}));
  }
  EXPECT_THAT(read("a\n1\n\n3\n").rows, ElementsAre(Row{1}, Row{std::nullopt}, Row{3}));
  EXPECT_TRUE(read("a,b\n").rows.empty());
}

TEST_F(Csv, RefusesEachBadInput) {
  EXPECT_THAT(refusal(""), EndsWith("t.csv: is empty, expected a line of column names"));
  EXPECT_THAT(refusal("a,b\n1\n"), EndsWith("t.csv:2: has 1 cells, expected 2 as in the first line"));
  EXPECT_THAT(refusal("a,b\n1,2\n1,2,3\n"), HasSubstr("t.csv:3: has 3 cells"));
  EXPECT_THAT(refusal("a,b\n1,2\n\n3,4\n"), HasSubstr("t.csv:3: has 1 cells"));
  EXPECT_THAT(refusal("a,a\n"), HasSubstr("t.csv:1: column 'a' is there twice"));
  EXPECT_THAT(refusal("a,\n"), HasSubstr("t.csv:1: column 2 has no name"));
  for (const char* cell : {"x", "12abc", "nan", "inf", "-inf", "NaN", "1e999", "0x10", "+1", " 1", "1 ",
                           "1;2", "\"1\"", "1.5.2", "--1", "\x01", "\xff\xfe"})
    EXPECT_THAT(refusal(std::string("a,b\n1,2\n3,") + cell + "\n"), HasSubstr("t.csv:3: column 'b': "))
        << cell;
  EXPECT_THAT(refusal(std::string("a\n1\0\n", 5)), HasSubstr("t.csv:2: column 'a'"));
}

TEST_F(Csv, FilesThatCannotBeRead) {
  const auto refusal_of = [&](const std::string& name) {
    return error_of<InputError>([&] { read_csv(folder_ / name); });
  };
  EXPECT_THAT(refusal_of("missing.csv"), EndsWith("missing.csv: could not read: No such file or directory"));
  EXPECT_THAT(refusal_of(""), HasSubstr("is a folder, expected a file"));
}

TEST_F(Csv, WritesNothingItWouldNotReadBack) {
  EXPECT_THROW(write_csv(path_, {}), std::logic_error);
  EXPECT_THROW(write_csv(path_, {{"a", "a"}, {}}), std::logic_error);
  EXPECT_THROW(write_csv(path_, {{"a,b"}, {}}), std::logic_error);
  EXPECT_THROW(write_csv(path_, {{"a\nb"}, {}}), std::logic_error);
  EXPECT_THROW(write_csv(path_, {{"a", "b"}, {{1}}}), std::logic_error);
  EXPECT_THAT(error_of<std::logic_error>([&] {
                write_csv(path_, {{"a", "b"}, {{1, 2}, {1, NAN}}});
              }),
              HasSubstr("row 1 of column 'b' to write is nan"));
  EXPECT_EQ(folder_.count(), 0u);
}

TEST_F(Csv, AMillionColumnsAreRefusedAtOnce) {
  std::string header = "bin";
  for (int i = 0; i < 1000000; ++i) header += ",c" + std::to_string(i);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(refusal(header + "\n"), HasSubstr("t.csv:1: has 1000001 columns, expected at most 65536"));
  header.resize(header.find(",c65535"));
  EXPECT_EQ(read(header + "\n").columns.size(), kMaxTableColumns);
  header.resize(header.find(",c65534"));
  EXPECT_THAT(refusal(header + ",c5\n"), HasSubstr("t.csv:1: column 'c5' is there twice"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));  // a minute under sanitizers
  EXPECT_THAT(refusal("a\n" + std::string(4000000, '\n')), HasSubstr("more than 16777216 cells"));
  EXPECT_THAT(refusal(std::string(17000000, ',')), HasSubstr("t.csv:1: has 17000001 columns"));
}

TEST_F(Csv, PipesAreRefused) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THAT(error_of<InputError>([&] { read_csv(path_); }), HasSubstr("t.csv: is not a regular file"));
}

TEST_F(Csv, FindColumn) {
  const Table table{{"bin", "ao"}, {}};
  EXPECT_EQ(find_column(table, "ao"), size_t{1});
  EXPECT_FALSE(find_column(table, "a"));
}

TEST_F(Csv, FullDisk) {
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a disk";
  const Table table{{"a"}, std::vector<Row>(200000, Row{0.5})};
  EXPECT_THAT(error_of<InputError>([&] { write_csv(disk / "t.csv", table); }),
              EndsWith("t.csv: could not write: No space left on device"));
  EXPECT_EQ(disk.count(), 0u);
}

TEST(CsvOfThePublishedExperiment, IsRead) {
  const std::filesystem::path path = HEMIBAKE_REFERENCE_DIR "/published_curves.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Table table = read_csv(path);
  ASSERT_EQ(table.columns.size(), 23u);  // bin, E0 to E20, sum_over_pi
  ASSERT_EQ(table.rows.size(), 100u);
  EXPECT_EQ(*table.rows[0][*find_column(table, "E0")], 0.04218207);
  EXPECT_EQ(*table.rows[99][*find_column(table, "sum_over_pi")], 1.007745);
}

TEST(Json, RoundTripKeepsOrder) {
  const TemporaryFolder folder;
  const auto json =
      nlohmann::ordered_json::parse(R"({"z":1,"a":{"value":0.1,"list":[1e300,null,"ü",true]}})");
  write_json(folder / "t.json", json);
  EXPECT_EQ(read_json(folder / "t.json").dump(), json.dump());
  EXPECT_THAT(read_bytes(folder / "t.json"),
              testing::AllOf(testing::StartsWith("{\n  \"z\": 1,"), EndsWith("}\n")));
}

TEST(Json, RefusesEachBadInput) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    write_bytes(folder / "t.json", text);
    return error_of<InputError>([&] { read_json(folder / "t.json"); });
  };
  EXPECT_THAT(refusal("{\"a\": 1,\n\"b\": }"),
              HasSubstr("t.json: line 2, column 6: '\"b\": }' does not go on"));
  for (const char* text :
       {"", "{", "{\"a\":NaN}", "[1,]", "1e999", "{\"a\":1} x", "\"\xff\"", "\x89HDF\n\r\n"})
    EXPECT_THAT(refusal(text), HasSubstr("t.json: ")) << text;
  EXPECT_THAT(refusal(std::string(1000000, '[')), HasSubstr("t.json: nests deeper than 64"));
  EXPECT_THROW(read_json(folder / "missing.json"), InputError);
}

TEST(Json, NeverWritesWhatIsNotFinite) {
  const TemporaryFolder folder;
  nlohmann::ordered_json json;
  json["F0"]["parameters"]["k"] = {0.5, std::nan("")};
  EXPECT_THAT(error_of<std::logic_error>([&] { write_json(folder / "t.json", json); }),
              HasSubstr("t.json/F0/parameters/k/1 is nan, expected a finite number"));
  json = INFINITY;
  EXPECT_THROW(write_json(folder / "t.json", json), std::logic_error);
  EXPECT_EQ(folder.count(), 0u);
}

}  // namespace
}  // namespace hemibake
