#include "cli/ending.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>

#include "cli/print/streams.h"
#include "core/error.h"

namespace hemibake {
namespace {

// Begins what oneTBB throws, as a plain runtime_error, where it can have no thread.
constexpr std::string_view kNoThread = "pthread_create has failed";

Ending internal_error(const std::string& what) {
  return {kExitInternalError,
          fmt::format("internal error: {}; please report it with the command and its input", what)};
}

[[noreturn]] void end_process() {
  const std::exception_ptr exception = std::current_exception();
  const Ending ending = exception ? ending_of(exception) : internal_error("ended without an exception");
  print_message(ending.message);
  _exit(ending.exit_code);
}

}  // namespace

Ending ending_of(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const SettingError& error) {
    return {kExitBadInput, error.with_prefix("--")};
  } catch (const InputError& error) {
    return {kExitBadInput, error.what()};
  } catch (const CheckError& error) {
    return {kExitFailedCheck, error.what()};
  } catch (const Cancelled&) {
    return {kExitInterrupted, "interrupted, no file was left half written"};
  } catch (const std::bad_alloc&) {
    return {kExitBadInput, "out of memory, expected less work (see --dry-run and --memory)"};
  } catch (const std::filesystem::filesystem_error& error) {
    return internal_error(error.what());
  } catch (const std::system_error& error) {
    // Names the limit of threads: that is what std::thread and its like throw for.
    return {kExitBadInput,
            fmt::format("the system refused: {}, expected fewer --threads", error.code().message())};
  } catch (const std::exception& error) {
    if (std::string_view(error.what()).starts_with(kNoThread))
      return {kExitBadInput,
              "the system refused another thread, expected more memory for it or fewer --threads"};
    return internal_error(error.what());
  } catch (...) {
    return internal_error("an exception of an unknown type");
  }
}

void end_on_uncaught_exceptions() { std::set_terminate(end_process); }

}  // namespace hemibake
