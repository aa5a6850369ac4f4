#include "flight/plans/levels.h"

#include "common/input.h"
#include "geo/local_frame.h"
#include "vantage/error.h"

namespace vantage::internal::flight::plans {

Levels::Levels(const std::optional<Georeference>& georeference, const HeightLevels& given) {
  const std::string vertical = georeference ? georeference->vertical : "";
  const bool is_ellipsoid = vertical == geo::kEllipsoidalHeight;
  level_ = vertical.empty() ? "an unknown level" : vertical;
  sea_level_z_m_ = given.sea_level_z_m;
  if (is_ellipsoid) {
    ellipsoid_z_m_ = 0;
    if (!sea_level_z_m_) sea_level_z_m_ = given.undulation_m;
    return;
  }
  if (!sea_level_z_m_) sea_level_z_m_ = geo::sea_level_z_m(vertical);
  if (sea_level_z_m_ && given.undulation_m) ellipsoid_z_m_ = *sea_level_z_m_ - *given.undulation_m;
}

double Levels::sea_level_z(const std::string& where) const {
  if (sea_level_z_m_) return *sea_level_z_m_;
  throw Error(ErrorCode::height_unknown,
              "a height above sea level is needed, and heights of the scene are above " + level_, where,
              level_ == geo::kEllipsoidalHeight
                  ? "say with --undulation (undulation_m in Python) how high the mean sea level lies above the "
                    "ellipsoid there"
                  : "say which z of the scene the mean sea level has ('scene.sea_level' of a mission)");
}

double Levels::ellipsoid_z(const std::string& where) const {
  if (ellipsoid_z_m_) return *ellipsoid_z_m_;
  throw Error(ErrorCode::height_unknown,
              "a height above the WGS 84 ellipsoid is needed, and heights of the scene are above " + level_, where,
              std::string("say with --undulation (undulation_m in Python) how high the mean sea level lies above the "
                          "ellipsoid there") +
                  (sea_level_z_m_ ? "" : ", and which z of the scene it has ('scene.sea_level' of a mission)"));
}

}  // namespace vantage::internal::flight::plans
