// Volumes as Python holds them: shared, never changed, so that arrays can outlive them.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "vantage/volume.h"

namespace vantage::python {

struct PyVolume {
  std::shared_ptr<const Volume> volume;
  double rounding_m = 0;    ///< of the file that it was read from
  std::string stated_hash;  ///< that file's; empty: it states none

  explicit PyVolume(Volume made, double rounding = 0, std::string hash = {})
      : volume(std::make_shared<const Volume>(std::move(made))), rounding_m(rounding), stated_hash(std::move(hash)) {}
  const Volume& operator*() const { return *volume; }
  const Volume* operator->() const { return volume.get(); }
};

}  // namespace vantage::python
