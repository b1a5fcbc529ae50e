#include "cli/options/parser.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <memory>
#include <sstream>

#include "cli/print/streams.h"
#include "core/error.h"
#include "core/version.h"

namespace hemibake {
namespace {

constexpr int kMaxThreads = 1024;

struct CommonOptions {
  bool json = false;
  int threads = 0;
};

bool is_positional(const Field& field) {
  return std::isupper(static_cast<unsigned char>(field.name[0])) != 0;
}

std::string option_name(const Field& field) { return is_positional(field) ? field.name : "--" + field.name; }

void set_field(const Field& field, const std::vector<std::string>& words) {
  try {
    field.value.set(words);
  } catch (const InputError& error) {
    throw InputError(option_name(field) + ": " + error.what());
  }
}

CLI::Option* add_flag(CLI::App& app, const Field& field) {
  return app.add_flag_callback(
      option_name(field), [field] { set_field(field, {}); }, field.help);
}

CLI::Option* add_option(CLI::App& app, const Field& field) {
  const std::string short_name = field.short_name.empty() ? "" : "-" + field.short_name + ",";
  CLI::Option* option = app.add_option(
      short_name + option_name(field),
      [field](const CLI::results_t& words) {
        set_field(field, words);
        return true;
      },
      field.help);
  option->type_name(field.value.type);
  if (field.value.separated) option->delimiter(',');
  option->allow_extra_args(field.value.most != 1);
  if (field.value.most < 0)
    option->expected(field.value.fewest, CLI::detail::expected_max_vector_size);
  else
    option->expected(field.value.fewest, field.value.most);
  if (const auto text = field.value.get())
    option->default_str(field.value.most != 1 ? "[" + *text + "]" : *text);
  if (!field.placeholder.empty()) option->option_text(field.placeholder);
  return option;
}

void add_field(CLI::App& app, const Field& field) {
  CLI::Option* option =
      field.value.kind == Value::Kind::kFlag ? add_flag(app, field) : add_option(app, field);
  if (field.required) option->required();
  if (!field.group.empty()) option->group(field.group);
}

void add_common_fields(CLI::App& app, CommonOptions& options) {
  add_field(app, option("json", flag(options.json),
                        "print one JSON object on standard output, everything else on standard error"));
  add_field(app, option("threads", whole(options.threads, 0, kMaxThreads), "threads to use, 0 = all"));
}

// An unset shell variable in quotes is never what was meant: `--links "$LINKS"` would write no links and say
// nothing.
void refuse_empty_arguments(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0')
      throw InputError(fmt::format("{}: is followed by an empty argument, expected a name or a value",
                                   i == 1 ? "hemibake" : argv[i - 1]));
}

// Names the command that is missing or unknown, and the others: CLI11 does neither.
std::string describe(const CLI::ParseError& error, const CLI::App& app, int argc, char** argv) {
  if (!app.get_subcommands().empty()) return error.what();
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names += (names.empty() ? "" : ", ") + command->get_name();
  return fmt::format("{}, expected one of {}",
                     argc > 1 ? fmt::format("'{}' is no command", argv[1]) : "no command", names);
}

}  // namespace

std::optional<ParsedCommand> parse_command_line(int argc, char** argv, std::span<const Command> commands) {
  const auto app = std::make_shared<CLI::App>(std::string("hemibake ") + kVersion +
                                              ": bakes the light on a height map and fits models of it for "
                                              "shaders.");
  app->set_version_flag("--version", kVersion);
  app->require_subcommand(1);
  CommonOptions common;
  std::vector<CommandSetup> setups;
  for (const Command& command : commands) {
    CLI::App* sub = app->add_subcommand(command.name, command.summary);
    setups.push_back(command.setup());
    for (const Field& field : setups.back().fields) add_field(*sub, field);
    add_common_fields(*sub, common);
    sub->footer(setups.back().footer);
  }
  refuse_empty_arguments(argc, argv);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw InputError(describe(error, *app, argc, argv));
    std::ostringstream text;
    app->exit(error, text, text);  // --help, --version
    print_result(text.str());
    return std::nullopt;
  }
  const CLI::App* called = app->get_subcommands().front();
  ParsedCommand parsed;
  for (size_t i = 0; i < commands.size(); ++i)
    if (called->get_name() == commands[i].name) parsed.setup = setups[i];
  parsed.given = [app, called](const std::string& name) {
    return called->get_option("--" + name)->count() > 0;
  };
  parsed.json = common.json;
  parsed.threads = common.threads;
  return parsed;
}

}  // namespace hemibake
