#include "io/gdal_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

#include "core/error.h"

namespace hemibake {
namespace {

// Only what holds terrain in files: none that asks a server, and few to register. Not PCRaster: its reader
// goes on for minutes over damaged tables.
constexpr const char* kDriverFunctions[] = {
    "GDALRegister_VRT",      "GDALRegister_GTiff",   "GDALRegister_HFA",
    "GDALRegister_AIGrid",   "GDALRegister_AAIGrid", "GDALRegister_GRASSASCIIGrid",
    "GDALRegister_SDTS",     "GDALRegister_DTED",    "GDALRegister_SRTMHGT",
    "GDALRegister_Terragen", "GDALRegister_netCDF",  "GDALRegister_USGSDEM",
    "GDALRegister_GSAG",     "GDALRegister_GSBG",    "GDALRegister_GS7BG",
    "GDALRegister_IDRISI",   "GDALRegister_SAGA",    "GDALRegister_BT",
    "GDALRegister_XYZ",      "GDALRegister_EHdr",    "GDALRegister_ENVI",
};

constexpr const char* kOptions[][2] = {
    {"CPL_VSIL_CURL_ALLOWED_EXTENSIONS", "none"},  // no network
    {"GDAL_VRT_ENABLE_PYTHON", "NO"},
    {"GDAL_CACHEMAX", "64"},  // MB
};

[[noreturn]] void refuse_library(const std::string& fault) {
  throw InputError(
      fmt::format("is terrain, which GDAL reads, but GDAL cannot be loaded ({}), expected {} as at build "
                  "time: install it, or "
                  "build hemibake again",
                  fault, HEMIBAKE_GDAL_LIBRARY));
}

void* find_function(void* library, const char* name) {
  void* function = dlsym(library, name);
  if (!function) refuse_library(fmt::format("it has no {}", name));
  return function;
}

GdalLibrary load_library() {
  void* library = dlopen(HEMIBAKE_GDAL_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (!library) refuse_library("it or a library that it needs is missing");
  GdalLibrary gdal;
#define HEMIBAKE_GDAL_LOAD(name) \
  gdal.name = reinterpret_cast<decltype(gdal.name)>(find_function(library, #name));
  HEMIBAKE_GDAL_FUNCTIONS(HEMIBAKE_GDAL_LOAD)
#undef HEMIBAKE_GDAL_LOAD
  for (const auto& [name, value] : kOptions) gdal.CPLSetConfigOption(name, value);
  gdal.OSRSetPROJEnableNetwork(0);
  // Also what GDAL, once there, hears from the TIFF library of others.
  gdal.CPLSetErrorHandler(gdal.CPLQuietErrorHandler);
  // A driver that this build of GDAL lacks is missed only where a file needs it.
  for (const char* name : kDriverFunctions)
    if (void* function = dlsym(library, name)) reinterpret_cast<void (*)()>(function)();
  return gdal;
}

}  // namespace

const GdalLibrary& gdal_library() {
  static const GdalLibrary gdal = load_library();
  return gdal;
}

GdalFaults::GdalFaults(const GdalLibrary& gdal) : gdal_(gdal) { gdal_.CPLPushErrorHandlerEx(take, this); }

GdalFaults::~GdalFaults() { gdal_.CPLPopErrorHandler(); }

void GdalFaults::take(CPLErr severity, CPLErrorNum, const char*) {
  auto& faults = *static_cast<GdalFaults*>(gdal_library().CPLGetErrorHandlerUserData());
  if (severity >= CE_Failure) faults.found_ = true;
}

}  // namespace hemibake
