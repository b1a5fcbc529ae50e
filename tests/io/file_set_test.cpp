#include "io/file_set.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "io/io_testing.h"
#include "io/provenance.h"
#include "io/table_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Writes a, b and their record.
void write_set(const TemporaryFolder& folder, const std::string& text) {
  OutputSet files;
  OutputFile& record = files.add(folder / "set.json");
  OutputFile& a = files.add(folder / "a");
  OutputFile& b = files.add(folder / "b");
  a.write("a" + text);
  b.write("b" + text);
  write_json(record, {{"files", hashes_of({&a, &b})}});
  files.commit();
}

TEST(FileSet, TellsFilesOfTwoRuns) {
  const TemporaryFolder folder;
  write_set(folder, "1");
  EXPECT_EQ(folder.count(), 3u);
  check_file_set(folder / "set.json");
  write_bytes(folder / "b", "b2");
  EXPECT_THAT(file_set_state(folder / "set.json").changed, ElementsAre("b"));
  EXPECT_THAT(error_of<InputError>([&] { check_file_set(folder / "set.json"); }),
              HasSubstr("/b: is not of the run that wrote set.json, expected the files of one run"));
  EXPECT_THAT(error_of<InputError>([&] { check_file_set(folder / "set.json", {"b"}); }),
              HasSubstr("/b: is not"));
  write_json(folder / "b", {{"provenance", {{"input_sha256", sha256_of_file(folder / "a")}}}});
  check_file_set(folder / "set.json", {"b"});
  fs::remove(folder / "b");
  EXPECT_THAT(file_set_state(folder / "set.json").missing, ElementsAre("b"));
  write_set(folder, "2");
  check_file_set(folder / "set.json");
}

// A process killed between two names leaves a record that names what is not there.
TEST(FileSet, TellsEveryMomentBetweenTwoNames) {
  const TemporaryFolder before, after, folder;
  write_set(before, "1");
  write_set(after, "2");
  const char* names[] = {"set.json", "a", "b"};
  for (size_t renamed = 1; renamed < 3; ++renamed) {
    for (size_t i = 0; i < 3; ++i)
      write_bytes(folder / names[i], read_bytes((i < renamed ? after : before) / names[i]));
    EXPECT_FALSE(file_set_state(folder / "set.json").changed.empty()) << renamed;
  }
}

TEST(FileSet, NamesFilesInFoldersBelowAndNoOthers) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "below");
  write_bytes(folder / "below/a", "a2");
  write_bytes(folder / "outside", "a2");
  write_json(folder / "set.json",
             {{"files", {{"below/a", "0"}, {"below/../outside", "0"}, {"/dev/null", "0"}}}});
  EXPECT_THAT(file_set_state(folder / "set.json").changed, ElementsAre("below/a"));
}

TEST(FileSet, RecordsThatSayNothing) {
  const TemporaryFolder folder;
  for (const char* text : {"{}", "[]", "{\"files\": 3}", "{", "{\"files\": {\"../x\": \"0\", \"\": 1}}"}) {
    write_bytes(folder / "set.json", text);
    EXPECT_THAT(file_set_state(folder / "set.json").changed, IsEmpty()) << text;
  }
  EXPECT_FALSE(file_set_state(folder / "missing.json").is_recorded);
}

TEST(FileSet, AllOrNothingGetsItsName) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of<InputError>([&] {
                OutputSet files;
                files.add(folder / "a").write("a");
                files.add(folder / "missing/b");
              }),
              HasSubstr("could not write"));
  EXPECT_EQ(folder.count(), 0u);
}

}  // namespace
}  // namespace hemibake
