#include "cli/run_hemibake.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>

#include "io/image_io.h"

namespace hemibake {

namespace fs = std::filesystem;

CommandResult run_shell(const std::string& line) {
  const TemporaryFolder folder;
  const fs::path out = folder / "out", err = folder / "err";
  const int status =
      std::system(fmt::format("( {} ) >'{}' 2>'{}' </dev/null", line, out.string(), err.string()).c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, read_bytes(out), read_bytes(err)};
}

CommandResult run_hemibake(const std::string& arguments) {
  return run_shell("'" HEMIBAKE_BINARY "' " + arguments);
}

void CliTest::write_map(const std::string& name, SyntheticKind kind, int width, int height) const {
  write_map(name, synthesize(kind, {.width = width, .height = height, .seed = 1, .angle_rad = {}}).heights);
}

void CliTest::write_map(const std::string& name, const Grid<float>& heights) const {
  write_height_map(folder_ / name, heights, make_provenance("test"));
}

CommandResult CliTest::run(const std::string& arguments, const std::string& before) const {
  // `exec`: a signal ends hemibake, not a shell around it.
  return run_shell(
      fmt::format("cd '{}' && {} exec '{}' {}", folder_.path().string(), before, HEMIBAKE_BINARY, arguments));
}

CommandResult CliTest::run_interrupted(const std::string& arguments, const std::string& signal) const {
  // A shell lets its jobs ignore SIGINT, which a program keeps. Fields 14 and 15 of /proc/PID/stat: processor
  // time in user and system mode, in ticks.
  return run_shell(
      fmt::format("cd '{}' && {{ env --default-signal '{}' {} --threads 1 & }} && pid=$! && polls=600 && "
                  "most=$(($(getconf CLK_TCK) * 3 / 2)) && "
                  "while [ $polls -gt 0 ] && read -r line </proc/$pid/stat && set -- $line && "
                  "[ $((${{14}} + ${{15}})) -lt $most ]; do polls=$((polls - 1)); sleep 0.1; done; "
                  "kill -{} $pid; wait $pid",
                  folder_.path().string(), HEMIBAKE_BINARY, arguments, signal));
}

CommandResult CliTest::run_well(const std::string& arguments) const {
  CommandResult result = run(arguments);
  EXPECT_EQ(result.exit_code, 0) << arguments << "\n" << result.standard_error;
  return result;
}

nlohmann::json CliTest::run_json(const std::string& arguments) const {
  const CommandResult result = run_well(arguments + " --json");
  nlohmann::json json = nlohmann::json::parse(result.standard_output, nullptr, false);
  EXPECT_TRUE(json.is_object()) << arguments << "\n" << result.standard_output;
  return json;
}

void CliTest::expect_refusal(const std::string& arguments, const testing::Matcher<std::string>& line,
                             const std::string& before) const {
  const auto files = listing();
  const CommandResult result = run(arguments, before);
  const std::string where = "hemibake " + arguments;
  EXPECT_EQ(result.exit_code, 2) << where;
  EXPECT_EQ(result.standard_output, "") << where;
  const std::string& error = result.standard_error;
  const std::string start = "hemibake: ";
  ASSERT_TRUE(error.starts_with(start) && error.find('\n') == error.size() - 1) << where << "\n" << error;
  EXPECT_THAT(error.substr(start.size(), error.size() - start.size() - 1), line) << where;
  EXPECT_EQ(listing(), files) << where;
}

std::map<std::string, std::string> CliTest::listing() const {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
    files[entry.path().string()] = entry.is_regular_file()
                                       ? fmt::format("{} bytes, {}", entry.file_size(),
                                                     entry.last_write_time().time_since_epoch().count())
                                       : "";
  return files;
}

}  // namespace hemibake
