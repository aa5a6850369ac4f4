// Confidence bounds on a share, from a count.
#pragma once

#include <cstddef>

namespace vantage::internal::verify {

/// The one-sided upper bound of Clopper and Pearson ("The use of confidence or fiducial limits illustrated in the case
/// of the binomial", Biometrika 1934): the largest share that would still show `hits` or fewer in `trials` with a
/// probability of 1 - `confidence`. For no hits 1 - (1 - confidence)^(1 / trials); for no trials, or hits alone, 1.
double upper_share_bound(std::size_t hits, std::size_t trials, double confidence = 0.95);

}  // namespace vantage::internal::verify
