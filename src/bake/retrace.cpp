#include "bake/retrace.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "core/constants.h"
#include "core/error.h"
#include "io/links_file.h"

namespace hemibake {

LightTransport retrace(const MapSettings& map_settings, const BakeSettings& settings,
                       const Context& context) {
  BakeSettings only_tracing = settings;
  only_tracing.outputs.clear();
  only_tracing.target_error.reset();
  only_tracing.trace_form_factors = only_tracing.keep_transport = true;
  return *bake(load_map(map_settings, settings.normal_length), only_tracing, context).transport;
}

namespace {

// Returns what decides the bytes of a bake and its links: two that agree in it belong together.
Provenance what_decides(const Provenance& provenance) {
  Provenance record = provenance.is_object() ? provenance : Provenance::object();
  for (const char* elsewhere : {"command", "input", "input_path", "normals", "normals_path"})
    record.erase(elsewhere);
  return record;
}

}  // namespace

LightTransport transport_from_links(const std::filesystem::path& links_path, const BakeFile& file) {
  LinksFile links = read_links(links_path);
  const Bake& bake = file.bake;
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}, expected the links of this bake", links_path.string(), what));
  };
  const auto input = [](const Provenance& p) {
    return p.is_object() && p.contains("input_sha256") ? p["input_sha256"].dump() : "";
  };
  if (input(links.provenance) != input(file.provenance)) refuse("is of another map");
  if (what_decides(links.provenance) != what_decides(file.provenance))
    refuse("is of another bake of this map");
  const uint64_t texels = static_cast<uint64_t>(bake.width) * static_cast<uint64_t>(bake.height);
  if (links.final_gather.rows != texels)
    refuse(fmt::format("has {} texels, the bake {}", links.final_gather.rows, texels));
  const uint32_t patches =
      links.patch_form_factors ? links.patch_form_factors->rows : links.final_gather.rows;
  if (links.final_gather.columns != patches ||
      (links.patch_form_factors && links.patch_form_factors->columns != patches) ||
      links.direct.size() != patches)
    refuse("its matrices do not fit each other");

  LightTransport transport;
  transport.direct_over_pi = Grid<float>(bake.width, bake.height);
  const std::vector<double> blocked = row_sums(links.final_gather);
  for (size_t i = 0; i < transport.direct_over_pi.size(); ++i)
    transport.direct_over_pi[i] = static_cast<float>(
        bake.irradiance.empty() ? 1 - blocked[i] : static_cast<double>(bake.irradiance[0][i]) / kPi);
  transport.final_gather = std::move(links.final_gather);
  if (!links.patch_form_factors) return transport;
  transport.patch_form_factors = std::move(*links.patch_form_factors);
  for (const float direct : links.direct)
    transport.patch_direct_over_pi.push_back(static_cast<float>(static_cast<double>(direct) / kPi));
  return transport;
}

}  // namespace hemibake
