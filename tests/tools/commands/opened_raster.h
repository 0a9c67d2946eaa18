#pragma once

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {

/// A raster as GDAL reads it.
class OpenedRaster {
 public:
  OpenedRaster(const Workspace& work, const std::string& name) {
    GDALAllRegister();
    file_.reset(GDALDataset::Open((work.folder() / name).c_str(), GDAL_OF_RASTER));
    if (!file_) {
      ADD_FAILURE() << "GDAL cannot open " << name;
      std::abort();
    }
    file_->GetGeoTransform(transform.data());
  }

  [[nodiscard]] int columns() const { return file_->GetRasterXSize(); }
  [[nodiscard]] int rows() const { return file_->GetRasterYSize(); }
  [[nodiscard]] GDALDataset& file() const { return *file_; }
  [[nodiscard]] GDALRasterBand& band(int number = 1) const { return *file_->GetRasterBand(number); }
  [[nodiscard]] std::vector<float> pixels(int number = 1) const {
    std::vector<float> values(static_cast<std::size_t>(columns()) * rows());
    EXPECT_EQ(band(number).RasterIO(GF_Read, 0, 0, columns(), rows(), values.data(), columns(),
                                    rows(), GDT_Float32, 0, 0),
              CE_None);
    return values;
  }
  [[nodiscard]] std::string structure(const char* name) const {
    const char* const value = file_->GetMetadataItem(name, "IMAGE_STRUCTURE");
    return value == nullptr ? "" : value;
  }

  std::array<double, 6> transform{};

 private:
  GDALDatasetUniquePtr file_;
};

}  // namespace spillway::test
