// Volumes that are kept from one run of a mission to the next, for those who change a mission and look at it again.
#pragma once

#include <cstddef>
#include <memory>

#include "vantage/export.h"

namespace vantage {

/// What runs of missions have computed of their targets, before the limits of navigation, and of the sensor besides the
/// range. Give it to each run in RunOptions::kept, with RunOptions::prepared. A target is computed again only where
/// something has changed that its volume depends on: the scene, the target itself, the range, the share that must be
/// seen, the tolerance. All must be the same to the bit. So results have the same bits as without it. While a limit is
/// dragged volumes are only cut again, and while one of several targets is dragged the others stay.
///
/// For the exact method; nothing is kept of targets with a radio link, nor of those without a volume. It holds what the
/// last run used and what the present one adds, at 32 bytes a facet, and the scenes of these; a target that is refused
/// is no run. Safe to use from many threads; runs of different missions at the same time take each other's place. Where
/// a scene is not given prepared, each run makes another one, and nothing fits.
class VANTAGE_API KeptVolumes {
 public:
  KeptVolumes();
  KeptVolumes(const KeptVolumes&) = delete;
  KeptVolumes& operator=(const KeptVolumes&) = delete;
  ~KeptVolumes();

  std::size_t count() const;  ///< volumes held
  std::size_t taken() const;  ///< how many volumes were not computed, in all runs so far
  void clear();               ///< drops all volumes; taken() stays

  struct Data;
  Data& data() { return *data_; }  ///< for run_mission

 private:
  std::unique_ptr<Data> data_;
};

}  // namespace vantage
