// How far a pilot may be from an aircraft that is flown in sight.
#pragma once

#include "vantage/export.h"

namespace vantage {

/// EASA, "Guidelines for UAS operations in the open and specific category - Ref to Regulation (EU) 2019/947", and the
/// same in SORA 2.5, AMC1 to Article 11: the smaller one of two distances counts. The attitude line of sight (ALOS) is
/// from where the pilot still tells the aircraft's position and direction, the detection line of sight (DLOS) from
/// where other aircraft are seen in time.
struct VisualRange {
  enum class Kind { multirotor, fixed_wing };  ///< helicopters count as multirotors
  double aircraft_size_m = 0;                  ///< characteristic dimension: the largest one, > 0
  Kind kind = Kind::multirotor;
  double visibility_m = 0;  ///< ground visibility, > 0; the guidelines ask for 5000 at least
};

/// 327 CD + 20 m of a multirotor, 490 CD + 30 m of a fixed wing, CD being the aircraft's size.
VANTAGE_API double attitude_line_of_sight_m(const VisualRange& of);

/// 0.3 times the visibility.
VANTAGE_API double detection_line_of_sight_m(const VisualRange& of);

/// The smaller one of both. Throws Error(input) for a size or a visibility that is not positive and finite.
VANTAGE_API double visual_range_m(const VisualRange& of);

}  // namespace vantage
