#include "maps/osm/text_objects.h"

#include <expat.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <osmium/builder/osm_object_builder.hpp>
#include <osmium/osm/types_from_string.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "common/input.h"
#include "maps/osm/refused_input.h"
#include "maps/osm/text_input.h"
#include "maps/osm/xml_bounds.h"

namespace vantage::internal::osm {
namespace {

using osmium::item_type;
using Handle = std::function<void(const osmium::memory::Buffer&)>;

constexpr const char* kFetchAgain = "download or export the map again";

struct TextMember {
  item_type type = item_type::undefined;
  std::int64_t ref = 0;
  std::string role;
  std::vector<osmium::NodeRef> nodes;  ///< of a way whose positions the relation has
};

/// An object while it is read.
struct TextObject {
  item_type type = item_type::undefined;
  std::vector<std::pair<std::string, std::string>> attributes, tags;  ///< attributes: id, version, visible
  bool is_deleted = false;                                            ///< by an editor that has not uploaded it
  osmium::Location location;
  std::vector<osmium::NodeRef> nodes;
  std::vector<TextMember> members;
};

item_type type_of(std::string_view name) {
  return name == "node"       ? item_type::node
         : name == "way"      ? item_type::way
         : name == "relation" ? item_type::relation
                              : item_type::undefined;
}

/// Elements that say something about the map, and hold nothing of it.
bool is_about_map(std::string_view name) {
  return name == "bounds" || name == "bound" || name == "note" || name == "meta" || name == "remark" ||
         name == "count" || name == "area" || name == "timeline" || name == "changeset" || name == "user";
}

/// What is told of a remark: of an error alone. Overpass also remarks on what it did not mind.
std::string error_in(const std::string& remark) {
  if (remark.find("error") == std::string::npos) return {};
  const std::string text = printable(remark);
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  constexpr std::size_t kLongest = 200;
  return text.substr(begin, std::min(kLongest, end - begin + 1));
}

/// Makes libosmium's objects, and hands them over in buffers.
class ObjectWriter {
 public:
  ObjectWriter(osmium::osm_entity_bits::type kinds, const Handle& handle) : kinds_(kinds), handle_(handle) {}

  bool wants(item_type type) const {
    return (osmium::osm_entity_bits::from_item_type(type) & kinds_) != osmium::osm_entity_bits::nothing;
  }

  void write(const TextObject& object) {
    if (object.type == item_type::undefined || !wants(object.type)) return;
    if (object.type == item_type::node) {
      osmium::builder::NodeBuilder builder(buffer_);
      add_head(builder, object);
      builder.object().set_location(object.location);
    } else if (object.type == item_type::way) {
      osmium::builder::WayBuilder builder(buffer_);
      add_head(builder, object);
      add_nodes(builder, object.nodes);
    } else {
      write_relation(object);
    }
    buffer_.commit();
    if (kinds_ == osmium::osm_entity_bits::relation) write_ways_of(object);
    if (buffer_.committed() > kPart) flush();
  }

  void flush() {
    if (buffer_.committed() > 0) handle_(buffer_);
    buffer_.clear();
  }

  /// A node of a way: its id by its position where it has none, below all ids that maps and editors give. The same
  /// position is the same node; one that has no position is a node of its own.
  osmium::NodeRef unnamed_node(osmium::Location at) {
    constexpr std::int64_t kHalfX = 1'800'000'000, kHalfY = 900'000'000, kNowhere = (std::int64_t{1} << 31) - 1;
    const std::int64_t x = at.valid() ? at.x() + kHalfX : static_cast<std::int64_t>(unplaced_++);
    const std::int64_t y = at.valid() ? at.y() + kHalfY : kNowhere;
    return {std::numeric_limits<std::int64_t>::min() + x * (std::int64_t{1} << 31) + y, at};
  }

 private:
  static constexpr std::size_t kPart = std::size_t{1} << 20;

  template <typename Builder>
  void add_head(Builder& builder, const TextObject& object) {
    for (const auto& [name, value] : object.attributes) builder.object().set_attribute(name.c_str(), value.c_str());
    if (object.is_deleted) builder.object().set_visible(false);
    builder.set_user("");
    if (object.tags.empty()) return;
    osmium::builder::TagListBuilder tags(buffer_, &builder);
    for (const auto& [key, value] : object.tags) {
      if (key.find('\0') != std::string::npos || value.find('\0') != std::string::npos) {
        throw RefusedInput(ErrorCode::map_syntax, "a text of the map, a tag or a name, holds a NUL byte", "",
                           kFetchAgain);
      }
      tags.add_tag(key, value);
    }
  }

  void add_nodes(osmium::builder::WayBuilder& builder, const std::vector<osmium::NodeRef>& nodes) {
    if (nodes.empty()) return;
    osmium::builder::WayNodeListBuilder list(buffer_, &builder);
    for (const osmium::NodeRef& node : nodes) list.add_node_ref(node);
  }

  void write_relation(const TextObject& object) {
    osmium::builder::RelationBuilder builder(buffer_);
    add_head(builder, object);
    if (object.members.empty()) return;
    osmium::builder::RelationMemberListBuilder list(buffer_, &builder);
    for (const TextMember& member : object.members) list.add_member(member.type, member.ref, member.role);
  }

  void write_ways_of(const TextObject& relation) {
    for (const TextMember& member : relation.members) {
      if (member.type != item_type::way || member.nodes.empty()) continue;
      {
        osmium::builder::WayBuilder builder(buffer_);
        builder.object().set_id(member.ref);
        builder.set_user("");
        add_nodes(builder, member.nodes);
      }
      buffer_.commit();
    }
  }

  osmium::osm_entity_bits::type kinds_;
  const Handle& handle_;
  osmium::memory::Buffer buffer_{kPart + (kPart >> 1), osmium::memory::Buffer::auto_grow::yes};
  std::uint32_t unplaced_ = 0;
};

class XmlReader {
 public:
  explicit XmlReader(ObjectWriter& writer) : writer_(writer), parser_(XML_ParserCreate(nullptr)) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
  }

  void add(const std::string& part, bool is_last) {
    bounds_.add(part);
    const XML_Status status = XML_Parse(parser_.get(), part.data(), static_cast<int>(part.size()), is_last);
    if (error_) std::rethrow_exception(error_);
    if (status == XML_STATUS_OK) return;
    const XML_Error code = XML_GetErrorCode(parser_.get());
    const bool is_cut =
        code == XML_ERROR_NO_ELEMENTS || code == XML_ERROR_UNCLOSED_TOKEN || code == XML_ERROR_UNCLOSED_CDATA_SECTION;
    refuse(is_cut ? "the file ends too early" : std::string("the XML is broken: ") + XML_ErrorString(code));
  }

  const std::string& remark() const { return remark_; }

 private:
  struct FreeParser {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };

  // Errors may not pass through Expat, which is C: they wait until it is left.
  template <typename Action>
  static void guarded(void* reader, const Action& action) {
    XmlReader& self = *static_cast<XmlReader*>(reader);
    if (self.error_) return;
    try {
      action(self);
    } catch (...) {
      self.error_ = std::current_exception();
      XML_StopParser(self.parser_.get(), XML_FALSE);
    }
  }
  static void on_start(void* reader, const char* name, const char** attributes) {
    guarded(reader, [&](XmlReader& self) { self.start(name, attributes); });
  }
  static void on_end(void* reader, const char* /*name*/) {
    guarded(reader, [](XmlReader& self) { self.end(); });
  }
  static void on_text(void* reader, const char* text, int length) {
    guarded(reader, [&](XmlReader& self) {
      if (self.is_in("remark", 2)) self.remark_.append(text, static_cast<std::size_t>(length));
    });
  }
  static void on_doctype(void* reader, const char*, const char*, const char*, int) {
    guarded(reader, [](XmlReader& self) { self.refuse("the XML is broken: a map has no DOCTYPE"); });
  }

  [[noreturn]] void refuse(const std::string& problem) const {
    throw RefusedInput(ErrorCode::map_syntax, problem,
                       "line " + std::to_string(XML_GetCurrentLineNumber(parser_.get())), kFetchAgain);
  }

  bool is_in(std::string_view name, std::size_t depth) const { return open_.size() == depth && open_.back() == name; }

  void start(std::string_view name, const char** attributes) {
    if (open_.empty()) {
      check_version(attributes);
    } else if (open_.size() == 1) {
      object_ = TextObject();
      object_.type = type_of(name);
      is_object_ = object_.type != item_type::undefined;
      if (!is_object_ && !is_about_map(name)) refuse("an element of the file is not of a map: " + printable(name));
      is_wanted_ = is_object_ && writer_.wants(object_.type);
      if (is_wanted_) begin_object(attributes);
    } else if (is_object_) {
      start_in_object(name, attributes);
    } else if (type_of(name) != item_type::undefined) {
      refuse("objects lie in an element of the file that is not of a map: " + printable(open_[1]));
    }
    open_.emplace_back(name);
  }

  void end() {
    open_.pop_back();
    if (open_.size() != 1 || !is_wanted_) return;
    writer_.write(object_);
    is_object_ = is_wanted_ = false;
  }

  template <typename Visit>
  static void each_attribute(const char** attributes, const Visit& visit) {
    for (; *attributes; attributes += 2) visit(std::string_view(attributes[0]), attributes[1]);
  }

  void check_version(const char** attributes) const {
    std::string version;
    each_attribute(attributes, [&](std::string_view name, const char* value) {
      if (name == "version") version = value;
    });
    if (version != "0.6") {
      refuse(version.empty() ? "the map does not say of which version of the format it is"
                             : "the map is of version " + in_quotes(version) + " of the format; 0.6 is read");
    }
  }

  void begin_object(const char** attributes) {
    each_attribute(attributes, [&](std::string_view name, const char* value) {
      if (name == "lon") {
        object_.location.set_lon(value);
      } else if (name == "lat") {
        object_.location.set_lat(value);
      } else if (name == "action") {
        object_.is_deleted = std::string_view(value) == "delete";
      } else if (name == "id" || name == "version" || name == "visible") {
        object_.attributes.emplace_back(name, value);
      }
    });
  }

  void start_in_object(std::string_view name, const char** attributes) {
    const bool is_way = object_.type == item_type::way, is_relation = object_.type == item_type::relation;
    if (open_.size() == 3 && is_relation && open_.back() == "member" && name == "nd") {
      if (is_wanted_) object_.members.back().nodes.push_back(node(attributes));
      return;
    }
    const bool is_place = name == "bounds" || name == "bbox" || name == "center";
    const bool is_known = name == "tag" || (name == "nd" && is_way) || (name == "member" && is_relation) || is_place;
    if (open_.size() != 2 || !is_known) {
      refuse("the XML is broken: unknown element in <" + open_.back() + ">: " + in_quotes(name));
    }
    if (!is_wanted_) return;
    if (name == "tag") add_tag(attributes);
    if (name == "nd") object_.nodes.push_back(node(attributes));
    if (name == "member") add_member(attributes);
  }

  void add_tag(const char** attributes) {
    std::string key, value_of_key;
    each_attribute(attributes, [&](std::string_view name, const char* value) {
      if (name == "k") key = value;
      if (name == "v") value_of_key = value;
    });
    object_.tags.emplace_back(std::move(key), std::move(value_of_key));
  }

  osmium::NodeRef node(const char** attributes) {
    osmium::Location location;
    const char* ref = nullptr;
    each_attribute(attributes, [&](std::string_view name, const char* value) {
      if (name == "ref") ref = value;
      if (name == "lon") location.set_lon(value);
      if (name == "lat") location.set_lat(value);
    });
    return ref ? osmium::NodeRef(osmium::string_to_object_id(ref), location) : writer_.unnamed_node(location);
  }

  void add_member(const char** attributes) {
    TextMember member;
    const char* ref = nullptr;
    each_attribute(attributes, [&](std::string_view name, const char* value) {
      if (name == "type") member.type = type_of(value);
      if (name == "ref") ref = value;
      if (name == "role") member.role = value;
    });
    if (member.type == item_type::undefined || !ref) refuse("the XML is broken: a member without a type or a ref");
    member.ref = osmium::string_to_object_id(ref);
    object_.members.push_back(std::move(member));
  }

  ObjectWriter& writer_;
  std::unique_ptr<XML_ParserStruct, FreeParser> parser_;
  XmlBounds bounds_;
  std::exception_ptr error_;
  std::vector<std::string> open_;
  TextObject object_;
  bool is_object_ = false, is_wanted_ = false;
  std::string remark_;
};

/// The characters of a text that comes in parts, for a parser that takes one after the other.
class Characters {
 public:
  Characters(TextInput& input, std::string part, const core::ProgressReporter& progress)
      : input_(input), progress_(progress), part_(std::move(part)) {}

  bool is_at_end() {
    met_end_ = at_ == part_.size();
    return met_end_;
  }
  bool met_end() const { return met_end_; }  ///< more was wanted than there is
  char current() const { return part_[at_]; }
  void advance() {
    if (++since_ > XmlBounds::kMostOfObject) {
      throw RefusedInput(
          ErrorCode::map_syntax,
          "an object of the map is longer than " + std::to_string(XmlBounds::kMostOfObject >> 20U) + " MiB", place(),
          "export the map again: no map needs that");
    }
    if (++at_ < part_.size()) return;
    passed_ += part_.size();
    part_ = input_.read();
    at_ = 0;
    progress_.report(input_.offset(), input_.size());
  }
  void begin_object() { since_ = 0; }
  std::string place() const { return "byte " + std::to_string(passed_ + at_); }

 private:
  TextInput& input_;
  const core::ProgressReporter& progress_;
  std::string part_;
  std::size_t at_ = 0;
  std::uint64_t passed_ = 0, since_ = 0;
  bool met_end_ = false;
};

struct CharacterIterator {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  Characters* characters = nullptr;  ///< null: the end

  char operator*() const { return characters->current(); }
  CharacterIterator& operator++() {
    characters->advance();
    return *this;
  }
  bool operator==(const CharacterIterator& other) const { return is_at_end() == other.is_at_end(); }
  bool operator!=(const CharacterIterator& other) const { return !(*this == other); }

 private:
  bool is_at_end() const { return !characters || characters->is_at_end(); }
};

/// {"elements": [{"type": "way", "id": 1, "nodes": [...], "geometry": [...], "tags": {...}}, ...], "remark": "..."}
class JsonReader {
 public:
  JsonReader(ObjectWriter& writer, Characters& characters) : writer_(writer), characters_(characters) {}

  bool has_elements() const { return has_elements_; }
  const std::string& unknown() const { return unknown_; }  ///< a list or an object that may hold some of the map
  const std::string& remark() const { return remark_; }

  // What the parser calls. They return whether to go on.
  bool null() {
    if (is_in(In::geometry)) positions_.emplace_back();
    return true;
  }
  bool boolean(bool value) { return take({value ? "true" : "false", std::nan(""), false}); }
  bool number_integer(std::int64_t value) { return take({std::to_string(value), static_cast<double>(value), false}); }
  bool number_unsigned(std::uint64_t value) { return take({std::to_string(value), static_cast<double>(value), false}); }
  bool number_float(double value, const std::string& text) { return take({text, value, false}); }
  bool string(std::string& text) { return take({std::move(text), std::nan(""), true}); }
  bool binary(nlohmann::json::binary_t& /*value*/) { return false; }
  bool key(std::string& text) {
    key_ = std::move(text);
    return true;
  }
  bool start_object(std::size_t /*size*/) {
    const In around = in_.empty() ? In::other : in_.back();
    if (in_.empty()) return enter(In::top);
    note_unknown();
    if (around == In::elements) {
      object_ = TextObject();
      type_.clear();
      positions_.clear();
      characters_.begin_object();
      return enter(In::element);
    }
    if (around == In::element && key_ == "tags") return enter(In::tags);
    if (around == In::members) {
      object_.members.emplace_back();
      positions_.clear();
      return enter(In::member);
    }
    if (around == In::geometry) {
      longitude_ = latitude_ = std::nan("");
      return enter(In::position);
    }
    return enter(In::other);
  }
  bool start_array(std::size_t /*size*/) {
    if (is_in(In::top) && key_ == "elements") {
      has_elements_ = true;
      return enter(In::elements);
    }
    note_unknown();
    if (is_in(In::element) && key_ == "nodes") return enter(In::nodes);
    if (is_in(In::element) && key_ == "members") {
      own_positions_.swap(positions_);
      return enter(In::members);
    }
    if ((is_in(In::element) || is_in(In::member)) && key_ == "geometry") return enter(In::geometry);
    return enter(In::other);
  }
  bool end_object() {
    const In ended = in_.back();
    in_.pop_back();
    if (ended == In::position) positions_.push_back(location(longitude_, latitude_));
    if (ended == In::member) end_member();
    if (ended == In::element) end_element();
    return true;
  }
  bool end_array() {
    if (is_in(In::members)) own_positions_.swap(positions_);
    in_.pop_back();
    return true;
  }
  bool parse_error(std::size_t /*position*/, const std::string& /*token*/, const nlohmann::json::exception& /*error*/) {
    refuse(characters_.met_end() ? "the file ends too early" : "the JSON is broken");
  }

 private:
  enum class In { other, top, elements, element, tags, nodes, geometry, position, members, member };
  struct Value {
    std::string text;
    double number;
    bool is_text;
  };

  [[noreturn]] void refuse(const std::string& problem) const {
    throw RefusedInput(ErrorCode::map_syntax, problem, characters_.place(), kFetchAgain);
  }
  void note_unknown() {
    if (is_in(In::top) && key_ != "elements" && key_ != "osm3s" && key_ != "bounds") unknown_ = key_;
  }
  bool is_in(In what) const { return !in_.empty() && in_.back() == what; }
  bool enter(In what) {
    constexpr std::size_t kDeepest = 100;
    if (in_.size() >= kDeepest) refuse("the JSON is nested deeper than 100 levels");
    in_.push_back(what);
    return true;
  }

  bool take(Value value) {
    switch (in_.empty() ? In::other : in_.back()) {
      case In::top:
        if (key_ == "remark") remark_ = std::move(value.text);
        break;
      case In::element:
        take_of_element(std::move(value));
        break;
      case In::nodes:
        object_.nodes.emplace_back(osmium::string_to_object_id(value.text.c_str()));
        break;
      case In::position:
        if (key_ == "lon") longitude_ = value.number;
        if (key_ == "lat") latitude_ = value.number;
        break;
      case In::member:
        take_of_member(std::move(value));
        break;
      case In::tags:
        if (!value.is_text) refuse("the value of a tag is no text");
        object_.tags.emplace_back(key_, std::move(value.text));
        break;
      default:
        break;
    }
    return true;
  }

  void take_of_element(Value value) {
    if (key_ == "type") type_ = std::move(value.text);
    if (key_ == "lon") own_longitude_ = value.number;
    if (key_ == "lat") own_latitude_ = value.number;
    if (key_ == "id" || key_ == "version" || key_ == "visible") {
      object_.attributes.emplace_back(key_, std::move(value.text));
    }
  }

  void take_of_member(Value value) {
    TextMember& member = object_.members.back();
    if (key_ == "type") member.type = type_of(value.text);
    if (key_ == "ref") member.ref = osmium::string_to_object_id(value.text.c_str());
    if (key_ == "role") member.role = std::move(value.text);
  }

  osmium::Location location(double longitude, double latitude) const {
    constexpr double kLargest = 200;  // libosmium keeps up to 214 degrees; what is not on the earth is told later
    if (!(std::abs(longitude) <= kLargest && std::abs(latitude) <= kLargest)) {
      refuse("a position has no longitude and latitude in degrees");
    }
    return {longitude, latitude};
  }

  void end_member() {
    TextMember& member = object_.members.back();
    if (member.type == item_type::undefined) refuse("a member of a relation is no node, way or relation");
    for (const osmium::Location& position : positions_) member.nodes.push_back(writer_.unnamed_node(position));
  }

  void end_element() {
    object_.type = type_of(type_);
    if (object_.type == item_type::undefined) {
      const bool is_built = std::any_of(object_.tags.begin(), object_.tags.end(), [](const auto& tag) {
        return tag.first.starts_with("building") || tag.first == "height";
      });
      if (type_ == "area" && is_built) refuse("an area of Overpass has no outline; ask for ways and relations instead");
      if (type_ == "count" || type_ == "area" || type_ == "timeline") return;  // of objects that are elsewhere
      refuse("an element is no node, way or relation: its type is " + (type_.empty() ? "not said" : printable(type_)));
    }
    const bool is_placed = !std::isnan(own_longitude_) || !std::isnan(own_latitude_);
    if (object_.type == item_type::node && is_placed) object_.location = location(own_longitude_, own_latitude_);
    own_longitude_ = own_latitude_ = std::nan("");
    std::vector<osmium::NodeRef>& nodes = object_.nodes;
    for (std::size_t i = 0; i < nodes.size() && nodes.size() == positions_.size(); ++i) {
      nodes[i].set_location(positions_[i]);
    }
    if (nodes.empty() && object_.type == item_type::way) {
      for (const osmium::Location& position : positions_) nodes.push_back(writer_.unnamed_node(position));
    }
    writer_.write(object_);
  }

  ObjectWriter& writer_;
  Characters& characters_;
  std::vector<In> in_;
  std::string key_, type_, remark_, unknown_;
  TextObject object_;
  std::vector<osmium::Location> positions_, own_positions_;  ///< of the list at hand; of the element, meanwhile
  double longitude_ = std::nan(""), latitude_ = std::nan(""), own_longitude_ = std::nan(""),
         own_latitude_ = std::nan("");
  bool has_elements_ = false;
};

[[noreturn]] void refuse_format(std::string_view text) {
  throw RefusedInput(ErrorCode::map_format_unknown,
                     "the file is not an OpenStreetMap file: it looks like " + guess_content(text, root_element(text)),
                     "", kMapFormats);
}

std::string read_json(TextInput& input, std::string part, ObjectWriter& writer,
                      const core::ProgressReporter& progress) {
  const std::string start = part.substr(0, 1);
  Characters characters(input, std::move(part), progress);
  JsonReader reader(writer, characters);
  nlohmann::json::sax_parse(CharacterIterator{&characters}, CharacterIterator{}, &reader);
  if (!reader.has_elements()) refuse_format(start);
  if (!reader.unknown().empty()) {
    throw RefusedInput(ErrorCode::map_syntax, "a member of the file is not of a map: " + printable(reader.unknown()),
                       "", kFetchAgain);
  }
  writer.flush();
  return error_in(reader.remark());
}

}  // namespace

std::string read_text(const std::filesystem::path& path, osmium::osm_entity_bits::type kinds,
                      const core::ProgressReporter& progress, const Handle& handle) {
  TextInput input(path);
  ObjectWriter writer(kinds, handle);
  std::string part = input.read();
  if (is_json_object(part)) return read_json(input, std::move(part), writer, progress);
  // Also that it is UTF-8, or else bounds would be looked for in vain.
  if (!part.empty() && root_element(part) != "osm") refuse_format(part);
  XmlReader reader(writer);
  for (; !part.empty(); part = input.read()) {
    reader.add(part, false);
    writer.flush();
    progress.report(input.offset(), input.size());
  }
  reader.add({}, true);
  return error_in(reader.remark());
}

}  // namespace vantage::internal::osm
