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

// Records the paths of the inputs from the file's own folder: they then hold from any folder, and when map
// and bake move together.
Provenance with_paths_from(const std::filesystem::path& file, const Provenance& provenance) {
  Provenance record = provenance;
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::weakly_canonical(file, error).parent_path();
  for (const char* key : {"input_path", "normals_path"}) {
    if (!record.contains(key)) continue;
    const std::filesystem::path input =
        std::filesystem::weakly_canonical(record[key].get<std::string>(), error);
    const std::string path = input.lexically_relative(folder).string();
    if (!error && !path.empty()) record[key] = valid_utf8(path);
  }
  return record;
}

}  // namespace

OutputFile& add_bake_files(const BakeResult& result, const Provenance& provenance,
                           const std::filesystem::path& bake_path, const std::filesystem::path& links_path,
                           OutputSet& files) {
  if (!links_path.empty()) {
    const LightTransport& transport = *result.transport;
    OutputFile& links = files.add(links_path);
    write_links(links, transport.final_gather,
                transport.patch_form_factors.empty() ? nullptr : &transport.patch_form_factors,
                irradiance_of(transport.patch_direct()), with_paths_from(links_path, provenance));
    links.finish();
  }
  OutputFile& bake = files.add(bake_path);
  write_bake(bake, result.planes, with_paths_from(bake_path, provenance));
  bake.finish();
  return bake;
}

}  // namespace hemibake
