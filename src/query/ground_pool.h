// What is made of the ground of limits, once for each surface.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "vantage/ground.h"

namespace vantage::internal::query {

/// `Made`: has a constructor that takes a Ground.
template <typename Made>
class PoolOfGrounds {
 public:
  std::shared_ptr<const Made> of(const Ground& ground) {
    for (const auto& [known, made] : known_) {
      if (known.surface == ground.surface && known.plane_z_m == ground.plane_z_m) return made;
    }
    return known_.emplace_back(ground, std::make_shared<const Made>(ground)).second;
  }

 private:
  std::vector<std::pair<Ground, std::shared_ptr<const Made>>> known_;
};

}  // namespace vantage::internal::query
