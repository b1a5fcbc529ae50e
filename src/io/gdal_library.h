// GDAL as a table of functions, loaded when the first terrain file is met: a start without terrain costs
// nothing.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <memory>

namespace hemibake {

// Every function of GDAL that is called.
#define HEMIBAKE_GDAL_FUNCTIONS(use)                                                                         \
  use(CPLGetErrorHandlerUserData) use(CPLPopErrorHandler) use(CPLPushErrorHandlerEx) use(                    \
      CPLQuietErrorHandler) use(CPLSetConfigOption) use(CPLSetErrorHandler) use(CSLDestroy) use(GDALClose)   \
      use(GDALCreate) use(GDALDatasetRasterIO) use(GDALGetBlockSize) use(GDALGetDataTypeName) use(           \
          GDALGetDataTypeSizeBits) use(GDALGetDatasetDriver) use(GDALGetDescription) use(GDALGetFileList)    \
          use(GDALGetDriverByName) use(GDALGetDriverLongName) use(GDALGetDriverShortName) use(               \
              GDALGetGeoTransform) use(GDALGetMaskBand) use(GDALGetMaskFlags) use(GDALGetMetadata)           \
              use(GDALGetRasterBand) use(GDALGetRasterColorInterpretation) use(                              \
                  GDALGetColorInterpretationName) use(GDALGetRasterCount) use(GDALGetRasterDataType)         \
                  use(GDALGetRasterNoDataValue) use(GDALGetRasterOffset) use(GDALGetRasterScale) use(        \
                      GDALGetRasterUnitType) use(GDALGetRasterXSize) use(GDALGetRasterYSize)                 \
                      use(GDALGetSpatialRef) use(GDALDataTypeIsComplex) use(GDALDataTypeIsFloating) use(     \
                          GDALDataTypeIsSigned) use(GDALOpenEx) use(GDALRasterIO) use(GDALSetDescription)    \
                          use(GDALSetGeoTransform) use(GDALSetMetadataItem) use(GDALSetRasterNoDataValue)    \
                              use(GDALSetSpatialRef) use(OCTDestroyCoordinateTransformation)                 \
                                  use(OCTNewCoordinateTransformation) use(OCTTransform) use(OSRClone)        \
                                      use(OSRCloneGeogCS) use(OSRDestroySpatialReference)                    \
                                          use(OSRExportToWktEx) use(OSRGetAngularUnits)                      \
                                              use(OSRGetInvFlattening) use(OSRGetLinearUnits)                \
                                                  use(OSRGetPrimeMeridian) use(OSRGetSemiMajor)              \
                                                      use(OSRGetTargetLinearUnits) use(OSRIsGeocentric)      \
                                                          use(OSRIsGeographic) use(OSRIsProjected)           \
                                                              use(OSRIsVertical) use(OSRNewSpatialReference) \
                                                                  use(OSRSetAxisMappingStrategy)             \
                                                                      use(OSRSetFromUserInput)               \
                                                                          use(OSRSetPROJEnableNetwork)       \
                                                                              use(VSIFree)                   \
                                                                                  use(VSIGetMemFileBuffer)   \
                                                                                      use(VSIUnlink)

struct GdalLibrary {
#define HEMIBAKE_GDAL_MEMBER(name) decltype(&::name) name = nullptr;
  HEMIBAKE_GDAL_FUNCTIONS(HEMIBAKE_GDAL_MEMBER)
#undef HEMIBAKE_GDAL_MEMBER
};

// Loads GDAL at the first call, with the drivers of terrain formats, no network and no Python. Throws
// InputError where this machine has none that fits.
const GdalLibrary& gdal_library();

// Notes whether GDAL finds a fault on this thread while it lives. Nothing reaches the terminal.
class GdalFaults {
 public:
  explicit GdalFaults(const GdalLibrary& gdal);
  ~GdalFaults();
  GdalFaults(const GdalFaults&) = delete;
  GdalFaults& operator=(const GdalFaults&) = delete;

  bool found() const { return found_; }

 private:
  static void CPL_STDCALL take(CPLErr severity, CPLErrorNum number, const char* message);

  const GdalLibrary& gdal_;
  bool found_ = false;
};

struct GdalDatasetCloser {
  void operator()(GDALDatasetH dataset) const { gdal_library().GDALClose(dataset); }
};
using GdalDataset = std::unique_ptr<void, GdalDatasetCloser>;

struct GdalReferenceCloser {
  void operator()(OGRSpatialReferenceH reference) const {
    gdal_library().OSRDestroySpatialReference(reference);
  }
};
using GdalReference = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, GdalReferenceCloser>;

}  // namespace hemibake
