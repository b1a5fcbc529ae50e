#include "io/output_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "core/error.h"
#include "core/temporary_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as the kernel follows

// Refuses a target that plain writing would refuse: a rename over a device or a read-only file succeeds, and
// destroys it.
void check_replaceable(const fs::path& path, const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status))
    throw InputError(fmt::format("{}: is a folder, expected the name of a file to write", path.string()));
  if (!fs::is_regular_file(status))
    throw InputError(
        fmt::format("{}: is not a regular file, expected the name of a file to write", path.string()));
  if (access(target.c_str(), W_OK) != 0) fail_write(path, errno);
}

// Gives a new file the permissions of the one that it replaces, and its owner where that is allowed.
void keep_mode(int descriptor, const struct stat& replaced) {
  const bool same_owner = fchown(descriptor, replaced.st_uid, replaced.st_gid) == 0;
  fchmod(descriptor, replaced.st_mode & (same_owner ? 07777U : 0777U));
}

}  // namespace

void fail_write(const fs::path& path, int error_number) {
  throw InputError(fmt::format("{}: could not write: {}", path.string(), std::strerror(error_number)));
}

fs::path resolve_target(const fs::path& path) {
  fs::path target = path;
  for (int i = 0; i < kMostLinks; ++i) {
    std::error_code error;
    const fs::path link = fs::read_symlink(target, error);
    if (error) return target;
    target = target.parent_path() / link;
  }
  fail_write(path, ELOOP);
}

std::string lower_case_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

OutputFile::OutputFile(const fs::path& path) : path_(path), target_(resolve_target(path)) {
  if (!path_.has_filename())
    throw InputError(fmt::format("'{}': expected the name of a file to write", path_.string()));
  check_replaceable(path_, target_);
  struct stat replaced {};
  const bool replaces = stat(target_.c_str(), &replaced) == 0;
  TemporaryFile file = make_temporary_file(target_.parent_path(), replaces ? 0600 : 0666);
  if (file.descriptor < 0) fail_write(path_, errno);
  descriptor_ = file.descriptor;
  temporary_path_ = std::move(file.path);
  if (replaces) keep_mode(descriptor_, replaced);
}

OutputFile::~OutputFile() {
  // Unlinked before its lock goes: until then the name is this one's.
  if (!committed_) unlink(temporary_path_.c_str());
  close(descriptor_);
}

void OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_write(path_, errno);
    bytes.remove_prefix(static_cast<size_t>(written));
  }
}

void OutputFile::finish() {
  while (fsync(descriptor_) != 0)
    if (errno != EINTR) fail_write(path_, errno);
  finished_ = true;
}

void OutputFile::commit() {
  if (!finished_) finish();
  if (rename(temporary_path_.c_str(), target_.c_str()) != 0) fail_write(path_, errno);
  committed_ = true;
}

OutputFile& OutputSet::add(const fs::path& path) {
  return *files_.emplace_back(std::make_unique<OutputFile>(path));
}

std::vector<fs::path> OutputSet::paths() const {
  std::vector<fs::path> paths;
  for (const auto& file : files_) paths.push_back(file->path());
  return paths;
}

void OutputSet::commit() {
  for (const auto& file : files_) file->finish();
  for (const auto& file : files_) file->commit();
}

void write_text_file(const fs::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

void check_output_path(const fs::path& path, std::initializer_list<std::string_view> suffixes) {
  const std::string extension = lower_case_extension(path);
  if (suffixes.size() > 0 && std::find(suffixes.begin(), suffixes.end(), extension) == suffixes.end())
    throw InputError(fmt::format("{}: cannot write '{}' files, expected {}", path.string(), extension,
                                 fmt::join(suffixes, " or ")));
  OutputFile{path};
}

}  // namespace hemibake
