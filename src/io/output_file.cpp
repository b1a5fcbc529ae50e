#include "io/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "core/error.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Returns the file that gets replaced: the path itself, or the target of a symbolic link.
fs::path resolve_target(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path target = fs::weakly_canonical(path, error);
  return error ? path : target;
}

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

fs::path make_temporary_name(const fs::path& target) {
  static std::atomic<unsigned> serial{0};
  return target.parent_path() /
         fmt::format(".{}.{}-{}{}", target.stem().string(), getpid(), serial++, target.extension().string());
}

}  // namespace

void fail_write(const fs::path& path, int error_number) {
  throw InputError(fmt::format("{}: could not write: {}", path.string(), std::strerror(error_number)));
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
  temporary_path_ = make_temporary_name(target_);
  descriptor_ = open(temporary_path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail_write(path_, errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!committed_) unlink(temporary_path_.c_str());
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
  if (fsync(descriptor_) != 0) fail_write(path_, errno);
  const int closed = close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail_write(path_, errno);
}

void OutputFile::commit() {
  if (descriptor_ >= 0) finish();
  if (rename(temporary_path_.c_str(), target_.c_str()) != 0) fail_write(path_, errno);
  committed_ = true;
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
