// Output of every command: --help for people, --json for programs.
#include <fmt/format.h>

#include "cli/run_hemibake.h"
#include "core/version.h"

namespace hemibake {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

struct CommandHelp {
  const char* command;
  std::vector<const char*> options;
};

// Options that scripts rely on: their names are a contract.
const std::vector<const char*> kBakeOptions = {
    "--channel",      "--size",    "--texel", "--amplitude", "--normals", "--normal-y", "--normals-from",
    "--edge",         "--tracer",  "--rays",  "--cone",      "--bounces", "--converge", "--max-bounces",
    "--max-distance", "--patches", "--links", "--outputs",   "--memory",  "--seed"};
const std::vector<CommandHelp> kCommands = {
    {"synth", {"--width", "--height", "--seed", "--angle"}},
    {"bake", {"--replay", "--dry-run"}},
    {"curves", {"--bins"}},
    {"fit", {"--model", "--abscissa", "--weights"}},
    {"render", {"--albedo", "--sky", "--sun", "--exposure", "--links", "--fit"}},
    {"check", {"--tolerance"}},
    {"run", {"--bins"}},
    {"report", {"--albedo", "--image-size"}}};

TEST(Help, NamesEveryPromisedOption) {
  for (const CommandHelp& command : kCommands) {
    const CommandResult help = run_hemibake(std::string(command.command) + " --help");
    EXPECT_EQ(help.exit_code, 0) << command.command;
    EXPECT_EQ(help.standard_error, "") << command.command;
    std::vector<const char*> options = command.options;
    options.insert(options.end(), {"--help", "--json", "--threads"});
    const std::string name = command.command;
    if (name == "bake" || name == "run")
      options.insert(options.end(), kBakeOptions.begin(), kBakeOptions.end());
    if (name != "check") options.push_back("-o,--output");
    for (const char* option : options)
      EXPECT_THAT(help.standard_output, ContainsRegex(fmt::format("{}[ ,]", option))) << name;
  }
}

TEST(Help, SaysUnitsRangesAndDefaults) {
  const std::string help = run_hemibake("bake --help").standard_output;
  // Option, range, default; then its meaning and unit on the next line.
  for (const char* line :
       {R"(--size FLOAT:in \(0 - 1000000000\])", R"(longer side, m; default: 1)",
        R"(over 0, m; default: 0\.1)", R"(--cone FLOAT:in \(0 - 180\]=180)", "degrees",
        R"(--rays [^ ]*in \[1 - 1048576\])", R"(azimuths of slices per texel \(default 64\))",
        R"(--bounces [^ ]*in \[0 - 1000\]=20)", R"(--edge TEXT:\{wrap,open,ground\}=wrap)", "share of pi",
        "GiB", "counts? as sky, m; default: no limit", R"(--threads [^ ]*in \[0 - 1024\]=0)"})
    EXPECT_THAT(help, ContainsRegex(line));
  EXPECT_THAT(run_hemibake("run --help").standard_output,
              ContainsRegex(R"(--bins [^ ]*in \[1 - 65536\]=100)"));
  EXPECT_THAT(run_hemibake("synth --help").standard_output,
              ContainsRegex(R"(--width [^ ]*in \[1 - [0-9]*\]=512)"));
}

TEST(Help, ListsTheCommands) {
  const CommandResult help = run_hemibake("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const CommandHelp& command : kCommands) EXPECT_THAT(help.standard_output, HasSubstr(command.command));
  const CommandResult version = run_hemibake("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.standard_output, kVersion + std::string("\n"));
}

class JsonOutput : public CliTest {};

TEST_F(JsonOutput, IsOneObjectOfEveryCommand) {
  EXPECT_EQ(run_json("synth bricks --width 48 --height 48 -o map.exr").at("width"), 48);
  EXPECT_GT(run_json("bake map.exr --dry-run").at("memory_bytes"), 0);
  EXPECT_EQ(run_json("bake map.exr --replay 5,7 --rays 16").at("texel"), nlohmann::json({5, 7}));
  const nlohmann::json bake = run_json("bake map.exr -o bake.exr --rays 64 --converge 1e-3 --max-bounces 20");
  EXPECT_GT(bake.at("rays_traced"), 0);
  // Warnings are for people too, so they go to standard error.
  EXPECT_FALSE(bake.at("warnings").empty());
  EXPECT_EQ(run_json("curves bake.exr -o curves.csv").at("bins"), 100);
  EXPECT_TRUE(run_json("fit curves.csv -o fit.json").contains("F1"));
  for (const std::string file : {"curves.csv", "fit.json"}) {
    const CommandResult check = run("check --json " + file);
    EXPECT_TRUE(nlohmann::json::parse(check.standard_output).is_object());
    EXPECT_EQ(check.standard_error, "");
  }
  EXPECT_TRUE(run_json("check bake.exr --tolerance 1").at("passed"));
  const nlohmann::json run = run_json("run map.exr -o results --rays 64");
  EXPECT_TRUE(run.contains("fits"));
  EXPECT_TRUE(run.at("check").at("passed"));
}

TEST_F(JsonOutput, NoControlCharactersWithoutATerminal) {
  write_map("map.exr", SyntheticKind::kBricks, 32, 32);
  const CommandResult result = run_well("bake map.exr -o bake.exr --rays 64");
  EXPECT_EQ(result.standard_error, "");
  EXPECT_THAT(result.standard_output, testing::Not(HasSubstr("\r")));
}

}  // namespace
}  // namespace hemibake
