#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "common/input.h"
#include "common/resources.h"
#include "core/format.h"
#include "core/system_limits.h"
#include "geo/local_frame.h"
#include "geo/proj_files.h"
#include "geo/proj_library.h"
#include "vantage/error.h"

namespace vantage::internal::geo {
namespace {

struct ContextDeleter {
  void operator()(PJ_CONTEXT* context) const { proj().proj_context_destroy(context); }
};
struct ObjectDeleter {
  void operator()(PJ* object) const { proj().proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, ContextDeleter>;
using Object = std::unique_ptr<PJ, ObjectDeleter>;

/// Keeps PROJ's last message, which would go to standard error.
void keep_message(void* text, int level, const char* message) noexcept {
  if (level != PJ_LOG_ERROR || !message) return;
  try {
    *static_cast<std::string*>(text) = message;
  } catch (const std::bad_alloc&) {  // a message less
  }
}

/// What PROJ 9.1 does not take as it stands: URLs of the OGC ("https://www.opengis.net/def/crs/EPSG/0/7415"), and PROJ
/// texts that do not say that they are a coordinate reference system.
std::string in_words_of_proj(const std::string& text) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    for (const std::string_view host : {"www.opengis.net/def/crs/", "opengis.net/def/crs/"}) {
      const std::string prefix = std::string(scheme).append(host);
      if (text.compare(0, prefix.size(), prefix) != 0) continue;
      const std::size_t authority_end = text.find('/', prefix.size());
      const std::size_t code = text.rfind('/');
      if (authority_end == std::string::npos || code == authority_end) return text;
      return text.substr(prefix.size(), authority_end - prefix.size()) + ":" + text.substr(code + 1);
    }
  }
  const bool proj_text = text.find("+proj=") != std::string::npos || text.find("+init=") != std::string::npos;
  return proj_text && text.find("+type=crs") == std::string::npos ? text + " +type=crs" : text;
}

/// Where PROJ looks for files: the resource folder first, if it has the database, then where others put grids. PROJ
/// looks in its own places where this is not called.
void set_search_paths(PJ_CONTEXT* context) {
  const std::filesystem::path resources = resource_folder();
  const std::filesystem::path folder = resources / "proj";
  std::error_code ignored;
  if (resources.empty() || !std::filesystem::is_regular_file(folder / "proj.db", ignored)) return;
  std::vector<std::filesystem::path> paths = folders_of_user();
  paths.insert(paths.begin(), folder);
  paths.insert(paths.end(), {"/usr/local/share/proj", "/usr/share/proj"});
  std::vector<std::string> names;
  for (const std::filesystem::path& path : paths) names.push_back(path.string());
  std::vector<const char*> pointers;
  for (const std::string& name : names) pointers.push_back(name.c_str());
  proj().proj_context_set_search_paths(context, static_cast<int>(pointers.size()), pointers.data());
}

bool is_one_of(PJ_TYPE type, std::initializer_list<PJ_TYPE> types) {
  for (const PJ_TYPE other : types) {
    if (type == other) return true;
  }
  return false;
}

}  // namespace

struct CoordinateSystem::Data {
  std::string message;  // before the context, which writes into it
  std::vector<std::filesystem::path> folders;
  Context context;
  Object to_wgs84;
  std::string code, name, vertical_name, where;
  Units units;
  bool geographic = false;
  std::array<double, 4> area_deg{};  // west, south, east, north
  std::string area_name;             // empty when PROJ knows no area

  Object create(const std::string& text) const;
  Object horizontal_part(Object system);
  std::optional<double> axis_unit_m(const PJ* system, int axis) const;
  void name_after(const PJ* system, const std::string& text);
  void read_area(const PJ* system);
  Eigen::Vector2d transform(const Eigen::Vector2d& from, PJ_DIRECTION direction) const;
};

Object CoordinateSystem::Data::create(const std::string& text) const {
  Object system;
  if (text.find('\0') == std::string::npos) {
    system.reset(proj().proj_create(context.get(), in_words_of_proj(text).c_str()));
  }
  if (system && proj().proj_is_crs(system.get())) return system;
  throw Error(ErrorCode::crs_unknown,
              "no known coordinate reference system: " + in_quotes(text) +
                  (message.empty() ? "" : " (" + in_quotes(message) + ")"),
              where, "give an EPSG code, as in EPSG:4326, or a WKT or PROJ text");
}

/// Metres in one unit of an axis, negative where it points down; nothing without such an axis.
std::optional<double> CoordinateSystem::Data::axis_unit_m(const PJ* system, int axis) const {
  const Object axes(proj().proj_crs_get_coordinate_system(context.get(), system));
  if (!axes || proj().proj_cs_get_axis_count(context.get(), axes.get()) <= axis) return std::nullopt;
  const char* direction = nullptr;
  double unit_m = 1;
  if (!proj().proj_cs_get_axis_info(context.get(), axes.get(), axis, nullptr, nullptr, &direction, &unit_m, nullptr,
                                    nullptr, nullptr)) {
    return std::nullopt;
  }
  return direction && std::string_view(direction) == "down" ? -unit_m : unit_m;
}

/// Notes the vertical axis, if there is one, and takes it off (where it is a system of its own).
Object CoordinateSystem::Data::horizontal_part(Object system) {
  if (proj().proj_get_type(system.get()) == PJ_TYPE_COMPOUND_CRS) {
    Object vertical(proj().proj_crs_get_sub_crs(context.get(), system.get(), 1));
    if (vertical && proj().proj_get_type(vertical.get()) == PJ_TYPE_BOUND_CRS) {
      vertical.reset(proj().proj_get_source_crs(context.get(), vertical.get()));
    }
    if (vertical) {
      vertical_name = proj().proj_get_name(vertical.get());
      units.vertical_m = axis_unit_m(vertical.get(), 0);
    }
    return Object(proj().proj_crs_get_sub_crs(context.get(), system.get(), 0));
  }
  units.vertical_m = axis_unit_m(system.get(), 2);
  if (units.vertical_m) vertical_name = "ellipsoidal height";
  return system;
}

void CoordinateSystem::Data::name_after(const PJ* system, const std::string& text) {
  const char* const known_as = proj().proj_get_name(system);
  const std::string long_name = known_as ? known_as : "";
  const char* const authority = proj().proj_get_id_auth_name(system, 0);
  const char* const number = proj().proj_get_id_code(system, 0);
  if (authority && number) {
    code = std::string(authority).append(":").append(number);
    name = code + " (" + long_name + ")";
  } else {
    name = long_name.empty() || long_name == "unknown" || long_name == "unnamed" ? in_quotes(text) : long_name;
  }
}

void CoordinateSystem::Data::read_area(const PJ* system) {
  constexpr double kUnknown = -1000;
  const char* known_as = nullptr;
  auto& [west, south, east, north] = area_deg;
  const bool is_known =
      proj().proj_get_area_of_use(context.get(), system, &west, &south, &east, &north, &known_as) != 0;
  if (is_known && west > kUnknown && known_as) area_name = known_as;
}

Eigen::Vector2d CoordinateSystem::Data::transform(const Eigen::Vector2d& from, PJ_DIRECTION direction) const {
  proj().proj_errno_reset(to_wgs84.get());
  PJ_COORD position{};
  position.xy = {from.x(), from.y()};
  const PJ_COORD to = proj().proj_trans(to_wgs84.get(), direction, position);
  if (from.allFinite() && std::isfinite(to.xy.x) && std::isfinite(to.xy.y)) return {to.xy.x, to.xy.y};
  const int fault = proj().proj_errno(to_wgs84.get());
  std::string problem = core::format("({:.12g}, {:.12g}) has no counterpart {}{}", from.x(), from.y(),
                                     direction == PJ_FWD ? "on the earth in " : "in ", name);
  if (fault) problem.append(": ").append(proj().proj_context_errno_string(context.get(), fault));
  throw Error(ErrorCode::too_far_away, problem, where,
              "check the coordinates, their order (east before north, longitude before latitude) and their system");
}

CoordinateSystem::CoordinateSystem(const std::string& text, const std::string& where)
    : data_(std::make_unique<Data>()) {
  data_->where = where;
  data_->context.reset(proj().proj_context_create());
  if (!data_->context) throw std::bad_alloc();
  PJ_CONTEXT* const context = data_->context.get();
  proj().proj_log_func(context, &data_->message, keep_message);
  proj().proj_context_set_enable_network(context, 0);
  set_search_paths(context);

  if (!proj().proj_context_get_database_path(context)) {
    core::check_open_files();
    throw Error(
        ErrorCode::library_missing, "PROJ's database of coordinate reference systems, proj.db, is not to be found",
        where,
        "install proj-data and libproj25 (Debian); if PROJ_DATA or PROJ_LIB is set, unset it or let it name the "
        "folder that holds proj.db");
  }

  data_->folders = data_folders(context);
  allow_files_in(context, data_->folders);

  Object system = data_->create(text);
  data_->name_after(system.get(), text);
  data_->read_area(system.get());
  system = data_->horizontal_part(std::move(system));
  Object plain;  // without a transformation to WGS 84 that the text itself may bring
  if (system && proj().proj_get_type(system.get()) == PJ_TYPE_BOUND_CRS) {
    plain.reset(proj().proj_get_source_crs(context, system.get()));
  }
  const PJ_TYPE type = system ? proj().proj_get_type(plain ? plain.get() : system.get()) : PJ_TYPE_UNKNOWN;
  data_->geographic = is_one_of(type, {PJ_TYPE_GEOGRAPHIC_2D_CRS, PJ_TYPE_GEOGRAPHIC_3D_CRS});
  if (!data_->geographic && type != PJ_TYPE_PROJECTED_CRS) {
    throw Error(ErrorCode::crs_unusable,
                data_->name + " is neither a geographic nor a projected coordinate reference system", where,
                "give one with longitude and latitude, or with eastings and northings");
  }
  if (!data_->geographic) {
    data_->units.horizontal_m = data_->axis_unit_m(plain ? plain.get() : system.get(), 0).value_or(1);
  }
  const Object wgs84(proj().proj_create(context, "EPSG:4326"));
  Object operation;
  if (wgs84) {
    operation.reset(proj().proj_create_crs_to_crs_from_pj(context, system.get(), wgs84.get(), nullptr, nullptr));
  }
  if (operation) data_->to_wgs84.reset(proj().proj_normalize_for_visualization(context, operation.get()));
  if (!data_->to_wgs84) {
    throw Error(ErrorCode::crs_unusable,
                "PROJ knows no way from " + data_->name + " to WGS 84" +
                    (data_->message.empty() ? "" : ": " + in_quotes(data_->message)),
                where, "convert the data to EPSG:4326 or to a projected system such as UTM");
  }
}
CoordinateSystem::~CoordinateSystem() = default;
CoordinateSystem::CoordinateSystem(CoordinateSystem&&) noexcept = default;
CoordinateSystem& CoordinateSystem::operator=(CoordinateSystem&&) noexcept = default;

LonLat CoordinateSystem::to_lonlat(const Eigen::Vector2d& position) const {
  const Eigen::Vector2d result = data_->transform(position, PJ_FWD);
  return {result.x(), result.y()};
}
Eigen::Vector2d CoordinateSystem::from_lonlat(LonLat position) const {
  return data_->transform({position.longitude_deg, position.latitude_deg}, PJ_INV);
}
bool CoordinateSystem::is_geographic() const { return data_->geographic; }
const std::string& CoordinateSystem::name() const { return data_->name; }
const std::string& CoordinateSystem::code() const { return data_->code; }
const std::string& CoordinateSystem::vertical_name() const { return data_->vertical_name; }
const CoordinateSystem::Units& CoordinateSystem::units() const { return data_->units; }
std::optional<std::string> CoordinateSystem::area_without(LonLat position) const {
  if (data_->area_name.empty()) return std::nullopt;
  const auto& [west, south, east, north] = data_->area_deg;
  const double longitude = std::remainder(position.longitude_deg, 360);
  const bool is_between = west <= east ? longitude >= west && longitude <= east  //
                                       : longitude >= west || longitude <= east;
  const bool is_inside = is_between && position.latitude_deg >= south && position.latitude_deg <= north;
  return is_inside ? std::nullopt : std::optional(data_->area_name);
}

}  // namespace vantage::internal::geo
