#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/options/command.h"
#include "core/error.h"
#include "core/version.h"
#include "fitting/fitted_model.h"
#include "io/file_context.h"
#include "io/fit_file.h"
#include "io/model_table.h"
#include "io/output_check.h"
#include "io/output_file.h"
#include "model/shader_text.h"

namespace hemibake {
namespace {

// Lists what a file can hold: shader text in a language, or a table.
struct Target {
  std::string name;  // of --to
  std::optional<Language> language;
  std::vector<std::string_view> endings;  // of files' names
};

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
      {"glsl",
       Language::kGlsl,
       {".glsl", ".frag", ".vert", ".comp", ".geom", ".gdshaderinc", ".gdshader", ".fs", ".vs"}},
      {"hlsl", Language::kHlsl, {".hlsl", ".hlsli", ".fx", ".fxh", ".usf", ".ush", ".cginc", ".compute"}},
      {"wgsl", Language::kWgsl, {".wgsl"}},
      {"msl", Language::kMsl, {".metal", ".msl"}},
      {"osl", Language::kOsl, {".osl"}},
      {"cpp", Language::kCpp, {".h", ".hpp", ".hh", ".hxx", ".cpp", ".cc", ".cxx"}},
      {"csv", std::nullopt, {".csv"}},
  };
  return all;
}

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const Target& target : targets()) names.push_back(target.name);
  return names;
}

struct ExportOptions {
  std::string fits;
  std::filesystem::path output;
  std::string target;
  std::string model = "bounded";
  std::string constants = "fit";
  std::string prefix;
  std::optional<double> bounce_albedo;
  std::optional<double> mean_escape;
  std::string map;
};

constexpr const char* kNoFits = "none";
// Headers of Metal and OSL end in .h too.
constexpr std::string_view kHeaderEnding = ".h";

const Target& named_target(std::string_view name) {
  return *std::ranges::find(targets(), name, &Target::name);
}

// Returns what to write, by --to and the file's name. Throws InputError where neither says or both disagree.
const Target& target_of(const ExportOptions& options) {
  std::string ending = options.output.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto by_name = std::ranges::find_if(
      targets(), [&](const Target& t) { return std::ranges::find(t.endings, ending) != t.endings.end(); });
  const std::string expected = fmt::format("{}", fmt::join(target_names(), ", "));
  if (options.target.empty()) {
    if (by_name != targets().end()) return *by_name;
    throw InputError(fmt::format(
        "{}: its name says no language, expected a name such as model.glsl, or --to with one of {}",
        options.output.string(), expected));
  }
  const Target& wanted = named_target(options.target);
  const bool header = ending == kHeaderEnding && wanted.language;
  if (by_name == targets().end() || by_name->name == wanted.name || header) return wanted;
  throw InputError(
      fmt::format("{}: its name says {}, but --to says {}; expected one of them, or both the same",
                  options.output.string(), by_name->name, wanted.name));
}

void check_prefix(const std::string& prefix) {
  const bool letters =
      std::ranges::all_of(prefix, [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '_'); });
  if (!letters || (!prefix.empty() && std::isdigit(static_cast<unsigned char>(prefix[0]))))
    throw InputError(fmt::format(
        "--prefix: '{}', expected letters, digits and underscores, and no digit at first", prefix));
}

// Sets the albedo of a bounce map: that of the option, else the one that the fits' bake recorded.
void set_bounce_albedo(AnyModel& model, const ExportOptions& options, const Provenance& provenance) {
  auto* map = std::get_if<BounceMapModel>(&model);
  if (!map) {
    if (!options.bounce_albedo) return;
    throw InputError(
        fmt::format("--bounce-albedo: the model {} has none, expected --model bounce-map", options.model));
  }
  constexpr const char* kKey = "bounce_albedo";
  if (options.bounce_albedo) {
    map->bounce_albedo = *options.bounce_albedo;
  } else if (provenance.contains(kKey) && provenance[kKey].is_number()) {
    map->bounce_albedo = provenance[kKey].get<double>();
    if (!(map->bounce_albedo >= 0.01 && map->bounce_albedo <= 0.999))
      throw InputError(
          fmt::format("{}: bounce_albedo is {}, expected 0.01 to 0.999", options.fits, map->bounce_albedo));
  }
}

// Throws InputError where the fits have no map that --map names, or none whose m is known.
std::vector<MapEscape> wanted_escapes(const ExportOptions& options, const FitFile& file) {
  std::vector<MapEscape> known, wanted;
  std::vector<std::string> names;
  for (const MapEscape& map : file.escapes) {
    if (!map.mean_escape) continue;
    known.push_back(map);
    names.push_back(map.map);
    if (map.map == options.map) wanted.push_back(map);
  }
  if (known.empty() || options.constants == kNoFits)
    throw InputError(
        fmt::format("{}: no mean escape share of a map, expected FIT.json as 'hemibake fit' writes it of a "
                    "bake or of curves with counts, or --mean-escape",
                    options.fits));
  if (options.map.empty()) return known;
  if (wanted.empty())
    throw InputError(fmt::format("--map: no map '{}' in {}, expected one of {}", options.map, options.fits,
                                 fmt::join(names, ", ")));
  return wanted;
}

// Sets the mean escape share: that of the option, else that of the fits' map, else the mean of their maps.
// Returns a line that says which.
std::string set_mean_escape(MeanEscapeModel& model, const ExportOptions& options, const FitFile& file) {
  if (options.mean_escape) {
    if (!options.map.empty())
      throw InputError("--map: --mean-escape gives the number already, expected one of them");
    model.mean_escape = *options.mean_escape;
    return "mean_escape: as given.";
  }
  const std::vector<MapEscape> maps = wanted_escapes(options, file);
  std::vector<std::string> names;
  model.mean_escape = 0;
  for (const MapEscape& map : maps) {
    names.push_back(map.map);
    model.mean_escape += *map.mean_escape / static_cast<double>(maps.size());
  }
  return fmt::format("mean_escape: {}{}.", maps.size() > 1 ? "the mean of " : "of ", fmt::join(names, ", "));
}

// Throws InputError where an option is given that only another model has.
void check_mean_escape_options(const ExportOptions& options, ModelKind kind) {
  if (kind == ModelKind::kMeanEscape) return;
  for (const auto& [name, given] : {std::pair("--mean-escape", options.mean_escape.has_value()),
                                    std::pair("--map", !options.map.empty())})
    if (given)
      throw InputError(fmt::format("{}: the model {} takes none, expected --model visibility-ao-mean", name,
                                   options.model));
}

struct Export {
  AnyModel model;
  std::vector<std::string> origin;
};

// Returns the model of FIT, or with the constants it has without one.
Export make_export(const ExportOptions& options) {
  const ModelKind kind = model_kind_from_string(options.model);
  const FitFile file = options.fits == kNoFits ? FitFile{} : read_fits(options.fits);
  check_mean_escape_options(options, kind);
  // The escape α needs no constants: those of a fit, if there is one, are a refinement.
  const bool optional = kind == ModelKind::kVisibilityNormal ||
                        (kind == ModelKind::kVisibilityAo && !has_model(file.fits, kind));
  Export result;
  if (options.fits == kNoFits || options.constants == kNoFits || optional) {
    const std::optional<AnyModel> model = model_without_fits(kind);
    if (!model)
      throw InputError(fmt::format("{}: the model {} has no constants without fits, expected FIT.json",
                                   options.fits, options.model));
    result = {*model, model_origin({}, ModelKind::kBounceMap)};
    result.origin.emplace_back(fmt::format("Model: {}, without constants fitted to a map.", options.model));
  } else {
    result = with_file_context(options.fits, [&] {
      return Export{any_fitted_model(file.fits, kind), model_origin(file, kind)};
    });
  }
  set_bounce_albedo(result.model, options, file.provenance);
  if (auto* model = std::get_if<MeanEscapeModel>(&result.model))
    result.origin.push_back(set_mean_escape(*model, options, file));
  return result;
}

int run_export(const ExportOptions& options, const Invocation& invocation) {
  const Target& target = target_of(options);
  check_prefix(options.prefix);
  check_output_path(options.output);
  refuse_overwriting_inputs({options.output}, {options.fits});
  const Export made = make_export(options);
  if (target.language) {
    OutputFile output(options.output);
    output.write(shader_text(made.model, *target.language, made.origin, options.prefix));
    output.commit();
  } else {
    write_csv(options.output, table_from_model(made.model));
  }
  invocation.print(
      {{"output", options.output.string()}, {"model", options.model}, {"to", target.name}},
      fmt::format("{}: the {} model as {}\n", options.output.string(), options.model, target.name));
  return 0;
}

}  // namespace

CommandSetup setup_export() {
  auto options = std::make_shared<ExportOptions>();
  CommandSetup setup;
  setup.fields = {
      required(option("FIT", text(options->fits),
                      "the fits, JSON as 'hemibake fit' writes it; none: a model that needs no fits")),
      required(
          output_option(options->output,
                        "the file to write; its name says the language: .glsl .frag .gdshaderinc, .hlsl .usf "
                        ".cginc, .wgsl, .metal, .osl, .h .hpp .cpp, .csv")),
      option("to", choice(options->target, target_names()),
             "source text in a language, or csv: a table over AO and albedo (default: by the file's name)"),
      option(
          "model", choice(options->model, model_kind_names()),
          "visibility: all light from V, the cosine-weighted AO; visibility-normal: from V and the z of the "
          "normal; visibility-ao: from V and the uniform AO; visibility-ao-mean: from these and the map's "
          "mean escape share; bounce-map: from two textures; of the uniform AO: bounded, or published (the "
          "formulas of 2018 with F0 and tau cut to 0..1); jimenez: their cubic of V"),
      option("constants", choice(options->constants, {"fit", kNoFits}),
             "of FIT, or none: those that a model has without fits (visibility: escape = V; visibility-ao: "
             "escape = AO; published: of 2018; jimenez: of 2016)"),
      option(
          "bounce-albedo", number(options->bounce_albedo, 0.01, 0.999),
          "the albedo that the second texture of bounce-map was baked with (default: as FIT's bake recorded "
          "it, else 0.9)"),
      option("mean-escape", number(options->mean_escape, 0, 1),
             "the map's m of visibility-ao-mean, (<V> - <V^2>)/(1 - <V>) (default: of the map in FIT; of "
             "several their mean)"),
      option("map", text(options->map), "whose m visibility-ao-mean takes, of several maps in FIT"),
      option(
          "prefix", text(options->prefix),
          "begins every name (default: constants and helpers begin with hemibake_, functions with nothing)"),
  };
  setup.run = [options](const Invocation& invocation) { return run_export(*options, invocation); };
  return setup;
}

}  // namespace hemibake
