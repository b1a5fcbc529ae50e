#include "io/json_text.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>

#include "io/io_testing.h"
#include "io/json_reader.h"

namespace hemibake {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

std::string refusal(const std::string& text) {
  return error_of<InputError>([&] { parse_json(text, "f.json"); });
}

std::string nested(size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST(JsonText, IsWhatTheLibraryParses) {
  for (const char* text : {"null", "[]", "{}", "\"ü\\u0000\"",
                           " [1, -2, 18446744073709551615, 1e3, true, {\"b\":{}, \"a\":[[],null]}] "})
    EXPECT_EQ(parse_json(text, "f.json"), ordered_json::parse(text)) << text;
  EXPECT_EQ(parse_json(nested(kMaxJsonDepth), "f.json").dump(), nested(kMaxJsonDepth));
}

TEST(JsonText, FaultsHaveAPlaceAndNoWordsOfTheLibrary) {
  EXPECT_EQ(refusal("{\"a\": 1,\n\"b\": }"),
            "f.json: line 2, column 6: '\"b\": }' does not go on as JSON, expected a whole document of it");
  for (const char* text : {"", "{", "{\"a\":NaN}", "[1,]", "[1e999]", "{\"a\":1} x", "\"\xff\"",
                           "\x89HDF\r\n", "'a'", "[\x1b[31m]", "{\"a\" 1}", "01", "\"\\ud800\""}) {
    const std::string error = refusal(text);
    EXPECT_THAT(error, testing::StartsWith("f.json: line ")) << text;
    EXPECT_THAT(error, testing::Not(HasSubstr("exception"))) << text;
    EXPECT_EQ(error.find('\x1b'), std::string::npos) << text;
  }
}

TEST(JsonText, DepthSizeAndNamesAreBounded) {
  EXPECT_EQ(refusal(nested(kMaxJsonDepth + 1)), "f.json: nests deeper than 64, expected less");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(refusal(nested(1000000)), "f.json: nests deeper than 64, expected less");
  std::string objects;
  for (int i = 0; i < 1000000; ++i) objects += "{\"a\":";
  EXPECT_EQ(refusal(objects), "f.json: nests deeper than 64, expected less");
  EXPECT_THAT(refusal("[" + std::string(kMaxJsonBytes, ' ') + "]"),
              HasSubstr("MiB of JSON, expected at most 64"));
  std::string list = "[0";
  for (size_t i = 0; i < kMaxJsonValues; ++i) list += ",0";
  EXPECT_THAT(refusal(list + "]"), HasSubstr("more than 2000000 values"));
  EXPECT_EQ(refusal(R"({"a": 1, "a": 2})"),
            "f.json: the name 'a' is there twice in an object, expected it once");
  // Names cost linear time.
  std::string names = "{\"n\":0";
  for (int i = 0; i < 300000; ++i) names += ",\"n" + std::to_string(i) + "\":0";
  EXPECT_EQ(parse_json(names + "}", "f.json").size(), 300001u);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

TEST(JsonText, AnyBytesAreParsedOrRefused) {
  const std::string good =
      R"({"F0":{"model":"m","parameters":{"A":{"value":2.0,"stderr":0.5}},"covariance":[[0.25]],)"
      R"("points":7,"aicc":null,"ok":true},"provenance":{"version":"1","input":"ü.png"}})";
  std::mt19937 random(18);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = good;
    for (unsigned k = 0; k <= random() % 6; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    const bool is_json = ordered_json::accept(bytes);
    try {
      const ordered_json parsed = parse_json(bytes, "f.json");
      ASSERT_TRUE(is_json) << bytes;
      EXPECT_EQ(parsed, ordered_json::parse(bytes));
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_TRUE(!is_json || text.find("twice") != std::string::npos) << text;
    } catch (const ordered_json::out_of_range&) {
      ADD_FAILURE() << "a number that is too large was taken";
    }
  }
}

TEST(JsonReader, ReadsWhatIsThere) {
  const ordered_json json = {{"number", 0.5},      {"whole", 3},         {"float", 3.0},
                             {"most", UINT64_MAX}, {"least", INT64_MIN}, {"flag", true},
                             {"text", "t"},        {"none", nullptr},    {"list", {1, 2}}};
  const JsonReader reader(json, "f.json");
  EXPECT_EQ(reader.at("number").number(0, 1), 0.5);
  EXPECT_EQ(reader.at("whole").number(), 3);
  EXPECT_EQ(reader.at("whole").whole<int>(), 3);
  EXPECT_EQ(reader.at("float").whole<uint32_t>(), 3u);
  EXPECT_EQ(reader.at("most").whole<uint64_t>(), UINT64_MAX);
  EXPECT_EQ(reader.at("least").whole<int64_t>(INT64_MIN), INT64_MIN);
  EXPECT_TRUE(reader.at("flag").flag());
  EXPECT_EQ(reader.at("text").text(), "t");
  EXPECT_FALSE(reader.at("none").number_or_null());
  EXPECT_EQ(reader.at("list").elements().at(1).number(), 2);
  EXPECT_FALSE(reader.find("other"));
  EXPECT_EQ(reader.members().size(), 9u);
}

TEST(JsonReader, NamesThePlaceOfWhatIsNot) {
  const ordered_json json = {{"a", {{"b", {1, "x\x1b[31m"}}}}};
  const JsonReader reader(json, "f.json");
  const auto fault = [](const auto& read) { return error_of<InputError>(read); };
  const auto list = reader.at("a").at("b").elements();
  EXPECT_EQ(fault([&] { list[1].number(); }), "f.json: a/b/1 is \"x\uFFFD[31m\", expected a number");
  EXPECT_EQ(fault([&] { list[0].text(); }), "f.json: a/b/0 is 1, expected a text");
  EXPECT_EQ(fault([&] { list[0].number(2, 3); }), "f.json: a/b/0 is 1, expected a number from 2 to 3");
  EXPECT_EQ(fault([&] { reader.at("a").elements(); }), "f.json: a is an object, expected a list");
  EXPECT_EQ(fault([&] { reader.at("a").at("c"); }), "f.json: a/c is not there, expected it");
  EXPECT_EQ(fault([&] { reader.text(); }), "f.json is an object, expected a text");
  for (const ordered_json& value :
       {ordered_json(0.5), ordered_json(-1), ordered_json(1e300), ordered_json(UINT64_MAX),
        ordered_json(true), ordered_json("1"), ordered_json()})
    EXPECT_THAT(fault([&] { JsonReader(value, "f.json").whole<int>(); }),
                HasSubstr("expected a whole number from 0"));
}

}  // namespace
}  // namespace hemibake
