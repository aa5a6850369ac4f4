// KML 2.2 (OGC 07-147r2): the polygons of all placemarks. XML is read with Expat, as maps are.
#include <expat.h>

#include <charconv>
#include <cmath>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/kml_zones.h"
#include "common/input.h"
#include "io/mesh_builder.h"

namespace vantage::internal::app {
namespace {

class KmlReader {
 public:
  KmlReader(const std::filesystem::path& file, const core::ProgressReporter& progress)
      : file_(file), progress_(progress), parser_(XML_ParserCreate(nullptr)) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
  }

  ZoneList read(std::string_view text);

 private:
  struct FreeParser {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };

  // Errors may not pass through Expat, which is C: they wait until it is left.
  template <typename Action>
  static void guarded(void* reader, const Action& action) {
    KmlReader& self = *static_cast<KmlReader*>(reader);
    if (self.error_) return;
    try {
      action(self);
    } catch (...) {
      self.error_ = std::current_exception();
      XML_StopParser(self.parser_.get(), XML_FALSE);
    }
  }
  static void on_start(void* reader, const char* name, const char**) {
    guarded(reader, [&](KmlReader& self) { self.start(local_name(name)); });
  }
  static void on_end(void* reader, const char* name) {
    guarded(reader, [&](KmlReader& self) { self.end(local_name(name)); });
  }
  static void on_text(void* reader, const char* text, int length) {
    guarded(reader, [&](KmlReader& self) { self.text_.append(text, static_cast<std::size_t>(length)); });
  }
  static void on_doctype(void* reader, const char*, const char*, const char*, int) {
    guarded(reader, [](KmlReader& self) { self.fail("a KML file has no DOCTYPE", "take it out"); });
  }
  /// "kml:Polygon" is "Polygon".
  static std::string local_name(std::string_view name) { return std::string(name.substr(name.rfind(':') + 1)); }

  void start(const std::string& name);
  void end(const std::string& name);
  void end_polygon();
  ListedRing ring_of(const ListedRing& positions);
  ListedRing positions() const;
  bool is_in(const char* name) const { return !open_.empty() && open_.back() == name; }
  std::string place() const { return "line " + std::to_string(XML_GetCurrentLineNumber(parser_.get())); }
  [[noreturn]] void fail(const std::string& problem, const std::string& fix = "correct it",
                         ErrorCode code = ErrorCode::zone_file_syntax) const {
    fail_in_zones(code, file_, place(), problem, fix);
  }

  const std::filesystem::path& file_;
  const core::ProgressReporter& progress_;
  std::unique_ptr<XML_ParserStruct, FreeParser> parser_;
  std::exception_ptr error_;
  std::vector<std::string> open_;
  std::string text_, name_, altitude_mode_, extrude_;
  std::optional<ListedZone> zone_;  // of the polygon that is open
  std::optional<double> altitude_m_;
  bool is_level_ = true;
  std::size_t placemarks_ = 0;
  ZoneList result_;
};

ZoneList KmlReader::read(std::string_view text) {
  const XML_Status status = XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), XML_TRUE);
  if (error_) std::rethrow_exception(error_);
  if (status != XML_STATUS_OK) {
    fail(std::string("the XML is broken: ") + XML_ErrorString(XML_GetErrorCode(parser_.get())), "save the file anew");
  }
  return std::move(result_);
}

void KmlReader::start(const std::string& name) {
  constexpr std::size_t kDeepest = 100;
  if (open_.empty() && name != "kml") {
    fail("not a file of zones: XML about <" + io::clean_name(name) + ">", "give KML");
  }
  if (open_.size() >= kDeepest) fail("elements are nested deeper than 100 levels");
  if (!open_.empty() && open_.back() == "coordinates") fail("there is an element among coordinates");
  open_.push_back(name);
  text_.clear();
  if (name == "Placemark") {
    name_.clear();
    ++placemarks_;
  }
  if (name == "Polygon") {
    if (zone_) fail("a polygon is inside of another one");
    zone_.emplace();
    if (!name_.empty()) zone_->names = {name_};
    zone_->name = name_.empty() ? std::to_string(result_.zones.size()) : name_;
    zone_->place = place();
    zone_->feature = placemarks_ > 0 ? placemarks_ - 1 : 0;
    altitude_mode_.clear();
    extrude_.clear();
    altitude_m_.reset();
    is_level_ = true;
  }
}

void KmlReader::end(const std::string& name) {
  progress_.tick();
  open_.pop_back();
  if (name == "name" && is_in("Placemark")) name_ = io::clean_name(text_);
  if (name == "altitudeMode" && is_in("Polygon")) altitude_mode_ = io::clean_name(text_);
  if (name == "extrude" && is_in("Polygon")) extrude_ = io::clean_name(text_);
  if (name == "coordinates" && is_in("LinearRing") && zone_) {
    const std::string around = open_.size() > 1 ? open_[open_.size() - 2] : "";
    const bool is_outer = around == "outerBoundaryIs";
    if (!is_outer && around != "innerBoundaryIs")
      fail("a ring of a polygon is neither its outer nor an inner boundary");
    if (is_outer && !zone_->outer.empty()) fail("a polygon has two outer boundaries");
    add_ring(ring_of(positions()), is_outer, *zone_);
  }
  if (name == "Polygon") end_polygon();
  if (name == "Point") ++result_.left_out["point"];
  if (name == "LineString" || name == "Track" || (name == "LinearRing" && !zone_)) ++result_.left_out["line"];
  if (name == "Model") ++result_.left_out["model"];
  if (name == "NetworkLink") ++result_.left_out["link to another file"];
  text_.clear();
}

/// A polygon at one height above the sea, extruded to the ground, is a zone below that height. At other heights it is a
/// surface, and says nothing of the space about it. `relativeToGround` lifts the corners from the ground under them,
/// and the surface between them does not follow the ground: to keep out of what is so far above the ground would be too
/// little over a valley, and to stay in it too much over a hill. So these heights are not used either.
void KmlReader::end_polygon() {
  if (zone_->outer.empty()) fail("a polygon has no outer boundary");
  const bool is_above_ground = altitude_mode_ == "relativeToGround", is_absolute = altitude_mode_ == "absolute";
  if (is_absolute && (extrude_ == "1" || extrude_ == "true") && is_level_ && altitude_m_) {
    zone_->has_heights = true;
    zone_->upper = ZoneHeight{*altitude_m_, HeightReference::sea_level};
  } else if (is_above_ground && altitude_m_) {
    zone_->unused_heights = ": altitudes that are relativeToGround are those of its corners alone";
  }
  if (is_absolute) zone_->corners_from = HeightReference::sea_level;
  if (is_above_ground) zone_->corners_from = HeightReference::ground;
  if (!is_absolute && !is_above_ground) zone_->corner_z_m.clear();  // clamped to the ground
  result_.zones.push_back(std::move(*zone_));
  zone_.reset();
}

ListedRing KmlReader::ring_of(const ListedRing& positions) {
  for (const double altitude_m : positions.z_m) {
    if (!altitude_m_ && !std::isnan(altitude_m)) altitude_m_ = altitude_m;
    is_level_ = is_level_ && altitude_m_ && *altitude_m_ == altitude_m;
  }
  return opened_ring(positions, file_, place());
}

/// "longitude,latitude[,altitude]", with blanks between them and none within.
ListedRing KmlReader::positions() const {
  constexpr std::string_view kBlanks = " \t\r\n";
  ListedRing positions;
  std::string_view rest = text_;
  for (;;) {
    const std::size_t begin = rest.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return positions;
    rest.remove_prefix(begin);
    const std::string_view tuple = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(tuple.size());
    double numbers[3] = {0, 0, 0};
    const char *at = tuple.data(), *const end = tuple.data() + tuple.size();
    int count = 0;
    for (; count < 3; ++count) {
      const auto [next, fault] = std::from_chars(at, end, numbers[count]);
      if (fault != std::errc() || !std::isfinite(numbers[count])) {
        at = nullptr;
        break;
      }
      at = next;
      if (at == end || *at != ',') {
        ++count;
        break;
      }
      if (count < 2) ++at;
    }
    if (at != end || count < 2) {
      fail("a position is not longitude,latitude,altitude: " + in_quotes(io::clean_name(tuple.substr(0, 60))),
           "write numbers with commas between them and no blanks");
    }
    positions.corners.push_back(checked_position(numbers[0], numbers[1], file_, place()));
    positions.z_m.push_back(count == 3 ? numbers[2] : std::nan(""));
  }
}

}  // namespace

ZoneList parse_kml_zones(std::string_view text, const std::filesystem::path& file,
                         const core::ProgressReporter& progress) {
  return KmlReader(file, progress).read(text);
}

}  // namespace vantage::internal::app
