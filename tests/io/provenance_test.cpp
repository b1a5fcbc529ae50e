#include "io/provenance.h"

#include <gmock/gmock.h>

#include "core/version.h"
#include "io/io_testing.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

TEST(Provenance, Sha256OfKnownTexts) {
  const TemporaryFolder folder;
  write_bytes(folder / "abc", "abc");  // FIPS 180-2, appendix B.1 and B.3
  EXPECT_EQ(sha256_of_file(folder / "abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  write_bytes(folder / "a", std::string(1000000, 'a'));
  EXPECT_EQ(sha256_of_file(folder / "a"), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  write_bytes(folder / "empty", "");
  EXPECT_EQ(sha256_of_file(folder / "empty"),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Provenance, UnreadableInputIsNamed) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of<InputError>([&] { sha256_of_file(folder / "missing.png"); }),
              testing::EndsWith("missing.png: could not read: No such file or directory"));
  EXPECT_THAT(error_of<InputError>([&] { sha256_of_file(folder.path()); }), HasSubstr("Is a directory"));
}

TEST(Provenance, NamesTheInputWithoutItsFolder) {
  const TemporaryFolder folder;
  write_bytes(folder / "map \xff.png", "abc");
  const Provenance provenance = make_provenance("hemibake bake", folder / "map \xff.png");
  EXPECT_EQ(provenance["version"], kVersion);
  EXPECT_EQ(provenance["command"], "hemibake bake");
  EXPECT_EQ(provenance["input"], "map \xEF\xBF\xBD.png");
  EXPECT_EQ(provenance["input_sha256"].get<std::string>().size(), 64u);
  check_provenance(provenance);
}

}  // namespace
}  // namespace hemibake
