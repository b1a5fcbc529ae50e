#include "bake/write.h"

#include "core/constants.h"
#include "io/bake_file.h"
#include "io/links_file.h"

namespace hemibake {
namespace {

std::vector<float> irradiance_of(const std::vector<float>& over_pi) {
  std::vector<float> irradiance(over_pi.size());
  for (size_t i = 0; i < over_pi.size(); ++i)
    irradiance[i] = static_cast<float>(kPi * static_cast<double>(over_pi[i]));
  return irradiance;
}

}  // namespace

void write_results(const BakeResult& result, const Provenance& provenance,
                   const std::filesystem::path& bake_path, const std::filesystem::path& links_path) {
  if (!links_path.empty()) {
    const LightTransport& transport = *result.transport;
    write_links(links_path, transport.final_gather,
                transport.patch_form_factors.empty() ? nullptr : &transport.patch_form_factors,
                irradiance_of(transport.patch_direct()), provenance);
  }
  write_bake(bake_path, result.planes, provenance);
}

}  // namespace hemibake
