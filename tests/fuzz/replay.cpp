// Runs files through the fuzz targets without libFuzzer: the corpus, mutations of it, and what fuzzing found.
//   hemibake_fuzz_replay CORPUS [MUTATIONS [TARGET…]]
// CORPUS:    a folder with a folder of files per target.
// MUTATIONS: of every file, 0 by default; the same ones at every run.
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/targets.h"
#include "io/input_file.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr itimerval kLongest = {{}, {10, 0}};  // of processor time
constexpr uint64_t kStream = 18;

// What runs now, for the line that a crash prints: kept for a signal handler, thus of fixed size.
char running[512];

void on_crash(int signal) {
  const auto print = [](const char* text) {
    if (write(STDERR_FILENO, text, std::char_traits<char>::length(text)) < 0) _exit(1);
  };
  print(signal == SIGPROF ? "took too long: " : "crashed: ");
  print(running);
  print("\n");
  _exit(1);
}

// Returns the bytes with one to eight places overwritten, cut short, or with a piece repeated.
std::string mutated(std::string bytes, uint64_t seed) {
  uint64_t draws = 0;
  const auto draw = [&](size_t below) {
    return static_cast<size_t>(mix_bits(seed, kStream, draws++) % std::max<size_t>(1, below));
  };
  if (bytes.empty()) return bytes;
  const size_t kind = draw(8);
  if (kind == 0) {
    bytes.resize(draw(bytes.size()));
    return bytes;
  }
  if (kind == 1) {
    const size_t begin = draw(bytes.size());
    return bytes.insert(draw(bytes.size()), bytes.substr(begin, draw(256)));
  }
  // The head of a file is where its structure stands: half of the places are there.
  static constexpr unsigned char kSpecial[] = {0, 1, 0x7f, 0x80, 0xff, '0', '-', '"', '[', ','};
  for (size_t left = 1 + draw(8); left > 0; --left) {
    const size_t at = draw(2) == 0 ? draw(std::min<size_t>(bytes.size(), 512)) : draw(bytes.size());
    bytes[at] = static_cast<char>(draw(2) == 0 ? kSpecial[draw(std::size(kSpecial))] : draw(256));
  }
  return bytes;
}

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

int replay(const fs::path& corpus, uint64_t mutations, const std::vector<std::string>& names) {
  size_t runs = 0;
  for (const FuzzTarget& target : fuzz_targets()) {
    if (!names.empty() && std::find(names.begin(), names.end(), target.name) == names.end()) continue;
    const std::vector<fs::path> files = files_of(corpus / target.name);
    if (files.empty()) {
      std::fprintf(stderr, "%s: the corpus has nothing for it\n", target.name);
      return 1;
    }
    for (const fs::path& file : files) {
      const std::string bytes = read_whole_file(file);
      for (uint64_t mutation = 0; mutation <= mutations; ++mutation, ++runs) {
        std::snprintf(running, sizeof running, "%s, mutation %llu", file.c_str(),
                      static_cast<unsigned long long>(mutation));
        setitimer(ITIMER_PROF, &kLongest, nullptr);
        run_fuzz_target(target, mutation == 0 ? bytes : mutated(bytes, mutation));
      }
    }
  }
  std::fprintf(stderr, "%zu runs, none crashed\n", runs);
  return 0;
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s CORPUS [MUTATIONS [TARGET…]]\n", argv[0]);
    return 2;
  }
  for (const int number : {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGPROF, SIGSEGV})
    signal(number, hemibake::on_crash);
  if (!std::freopen("/dev/null", "w", stdout)) return 1;
  const uint64_t mutations = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 0;
  return hemibake::replay(argv[1], mutations, {argv + std::min(argc, 3), argv + argc});
}
