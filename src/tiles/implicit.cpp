#include "tiles/implicit.h"

#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "io/json_text.h"

namespace vantage::internal::tiles {
namespace {

// A tree may announce more levels than are needed: Walk stops where coordinates become too large.
constexpr std::uint32_t kMostLevels = 1U << 31U;
constexpr std::uint32_t kMostSubtreeLevels = 21;
// Bits of one subtree: a quadtree of 12 levels, an octree of 8.
constexpr std::uint64_t kMostBits = std::uint64_t{1} << 25U;
constexpr std::size_t kLongestTemplate = 4096;
// Of the buffers of one subtree, and of what is taken from them: an availability has at most 6 MB.
constexpr std::uint64_t kMostSubtreeBytes = std::uint64_t{64} << 20U;

std::uint64_t whole_of(const Json& object, const char* key, std::uint64_t otherwise, std::uint64_t most) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  const double value = found->is_number() ? found->get<double>() : -1;
  if (!(value >= 0 && value <= static_cast<double>(most)) || value != std::floor(value)) {
    throw std::string("\"") + key + "\" is not a whole number of 0 to " + std::to_string(most);
  }
  return static_cast<std::uint64_t>(value);
}

const Json& member_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) throw std::string("\"") + key + "\" is missing";
  return *found;
}

std::uint64_t load_whole(const std::string& bytes, std::size_t at) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

/// The JSON of a subtree and its buffers.
struct Subtree::Parts {
  Json json;
  std::string binary;
  const ReadFile& read_file;
  std::uint64_t room;                          // for further bytes of other files
  std::map<std::string, std::string> buffers;  // by URI

  const std::string& buffer(std::uint64_t index) {
    const Json& all = member_of(json, "buffers");
    if (!all.is_array() || index >= all.size() || !all[index].is_object()) throw std::string("a buffer is missing");
    const auto uri = all[index].find("uri");
    if (uri == all[index].end()) return binary;
    if (!uri->is_string()) throw std::string("the \"uri\" of a buffer is not a text");
    const std::string name = uri->get<std::string>();
    if (const auto known = buffers.find(name); known != buffers.end()) return known->second;
    std::string bytes = read_file(name);
    take(bytes.size());
    return buffers[name] = std::move(bytes);
  }

  void take(std::uint64_t bytes) {
    if (bytes > room) throw std::string("its buffers are too large together");
    room -= bytes;
  }

  /// The first `wanted` bytes of a buffer view: many may name the same one.
  std::string view(std::uint64_t index, std::uint64_t wanted) {
    const Json& all = member_of(json, "bufferViews");
    if (!all.is_array() || index >= all.size() || !all[index].is_object()) {
      throw std::string("a buffer view is missing");
    }
    constexpr std::uint64_t kMost = std::uint64_t{1} << 40U;
    const std::uint64_t start = whole_of(all[index], "byteOffset", 0, kMost);
    const std::uint64_t length = whole_of(all[index], "byteLength", 0, kMost);
    const std::string& bytes = buffer(whole_of(all[index], "buffer", 0, kMost));
    if (start + length > bytes.size()) throw std::string("a buffer view goes beyond the end of its buffer");
    if (length < wanted) throw std::string("an availability has too few bits");
    take(wanted);
    return bytes.substr(start, wanted);
  }
};

Subtree::Bits Subtree::bits(const Json& described, std::uint64_t count, Parts& parts) {
  if (!described.is_object()) throw std::string("an availability is not an object");
  Bits bits;
  if (described.contains("constant")) {
    bits.all = whole_of(described, "constant", 0, 1) == 1;
    return bits;
  }
  const char* const key = described.contains("bitstream") ? "bitstream" : "bufferView";
  member_of(described, key);
  bits.is_constant = false;
  bits.bytes = parts.view(whole_of(described, key, 0, 1U << 20U), (count + 7) / 8);
  return bits;
}

Subtree::Subtree(const std::string& bytes, const Shape& shape, const ReadFile& read_file,
                 const core::ProgressReporter& progress, const core::ReadLimits& limits)
    : shape_(shape) {
  constexpr std::size_t kHeader = 24;
  Parts parts{{}, {}, read_file, kMostSubtreeBytes, {}};
  std::string_view text = bytes;
  if (bytes.starts_with("subt")) {
    if (bytes.size() < kHeader) throw std::string("it ends in its header");
    const std::uint64_t json = load_whole(bytes, 8), binary = load_whole(bytes, 16), room = bytes.size() - kHeader;
    if (json > room || binary > room - json) throw std::string("it ends before the length that it announces");
    text = text.substr(kHeader, json);
    parts.binary = bytes.substr(kHeader + json, binary);
  }
  try {
    parts.json = io::parse_json(text, progress, limits);
  } catch (const io::JsonProblem& problem) {
    throw problem.text;
  }
  if (!parts.json.is_object()) throw std::string("its JSON is not an object");
  const std::uint64_t inside = before(shape.levels);
  tiles_ = bits(member_of(parts.json, "tileAvailability"), inside, parts);
  children_ = bits(member_of(parts.json, "childSubtreeAvailability"), before(shape.levels + 1) - inside, parts);
  read_contents(inside, parts);
}

/// One for each content of the tile: an array (1.1) or, of a single one, an object (1.0), at the top, or in the
/// extension of 1.0 for the contents that are there.
std::vector<const Json*> Subtree::availabilities(const Parts& parts) const {
  const auto list = [](const Json& holder) {
    std::vector<const Json*> found;
    const auto described = holder.is_object() ? holder.find("contentAvailability") : holder.end();
    if (described == holder.end()) return found;
    if (!described->is_array()) return std::vector<const Json*>{&*described};
    for (const Json& one : *described) found.push_back(&one);
    return found;
  };
  const auto extensions = parts.json.find("extensions");
  const bool has_extension =
      extensions != parts.json.end() && extensions->is_object() && extensions->contains("3DTILES_multiple_contents");
  std::vector<const Json*> own = list(parts.json);
  if (!has_extension) return own;
  std::vector<const Json*> others = list((*extensions)["3DTILES_multiple_contents"]);
  if (others.size() >= shape_.contents) return others;
  if (others.size() < shape_.extension_contents) return own;
  // A "content" beside the extension's. If nothing is said of it, each tile has one: a file that there is not is told.
  std::vector<const Json*> all = own;
  all.resize(shape_.contents - shape_.extension_contents, &member_of(parts.json, "tileAvailability"));
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

/// To take what is missing for "no content" would lose surfaces unseen.
void Subtree::read_contents(std::uint64_t count, Parts& parts) {
  if (shape_.contents == 0) return;
  const std::vector<const Json*> described = availabilities(parts);
  for (std::size_t i = 0; i < described.size() && i < shape_.contents; ++i) {
    contents_.push_back(bits(*described[i], count, parts));
  }
  if (contents_.size() < shape_.contents) {
    throw "it has the availability of " + std::to_string(contents_.size()) + " of " + std::to_string(shape_.contents) +
        " contents";
  }
}

std::uint64_t Subtree::before(std::uint32_t level) const {
  std::uint64_t count = 0, width = 1;
  for (std::uint32_t i = 0; i < level; ++i) {
    count += width;
    width *= shape_.children;
  }
  return count;
}

bool Subtree::has_tile(std::uint32_t level, std::uint64_t morton) const { return tiles_.has(before(level) + morton); }

bool Subtree::has_content(std::size_t content, std::uint32_t level, std::uint64_t morton) const {
  return contents_[content].has(before(level) + morton);
}

ImplicitTree::ImplicitTree(std::shared_ptr<const TilesetDocument> of, const Tile& root, double root_error_m)
    : document(std::move(of)), bounds(root.bounds), error_m(root_error_m), contents(root.contents) {
  const Json& described = *root.implicit;
  try {
    const Json& scheme = member_of(described, "subdivisionScheme");
    is_octree = scheme == "OCTREE";
    if (!is_octree && scheme != "QUADTREE") throw std::string("\"subdivisionScheme\" is neither QUADTREE nor OCTREE");
    shape.children = is_octree ? 8 : 4;
    shape.contents = contents.size();
    shape.extension_contents = root.extension_contents;
    shape.levels = static_cast<std::uint32_t>(whole_of(described, "subtreeLevels", 0, kMostSubtreeLevels));
    const bool is_older = !described.contains("availableLevels") && described.contains("maximumLevel");
    levels = static_cast<std::uint32_t>(is_older ? whole_of(described, "maximumLevel", 0, kMostLevels - 1) + 1
                                                 : whole_of(described, "availableLevels", 0, kMostLevels));
    const double bits = std::pow(shape.children, shape.levels);
    if (shape.levels == 0 || levels == 0 || bits > static_cast<double>(kMostBits)) {
      throw std::string("its subtrees have too many levels, or none");
    }
    const Json& files = member_of(described, "subtrees");
    const auto uri = files.is_object() ? files.find("uri") : files.end();
    if (!files.is_object() || uri == files.end() || !uri->is_string())
      throw std::string("its subtrees have no \"uri\"");
    subtrees = uri->get<std::string>();
    // They are filled in for each tile.
    const auto is_long = [](const std::string& uri_template) { return uri_template.size() > kLongestTemplate; };
    if (is_long(subtrees) || std::any_of(contents.begin(), contents.end(),
                                         [&](const ContentName& content) { return is_long(content.uri); })) {
      throw "a template of addresses has more than " + std::to_string(kLongestTemplate) + " characters";
    }
  } catch (const std::string& problem) {
    document->fail("implicit tiling: " + problem);
  }
}

Volume ImplicitTree::bounds_of(const TileIndex& index) const {
  const double parts = std::ldexp(1, static_cast<int>(index.level));
  const auto fraction = [&](std::size_t axis) { return static_cast<double>(index.at[axis]) / parts; };
  const std::size_t axes = is_octree ? 3 : 2;
  if (const auto* const box = std::get_if<OrientedBox>(&bounds)) {
    OrientedBox part = *box;
    for (std::size_t i = 0; i < axes; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      part.center += box->half_axes.col(column) * (2 * fraction(i) + 1 / parts - 1);
      part.half_axes.col(column) /= parts;
    }
    return part;
  }
  if (const auto* const region = std::get_if<EarthRegion>(&bounds)) {
    EarthRegion part = *region;
    const double east = region->east < region->west ? region->east + 2 * EIGEN_PI : region->east;
    const auto split = [&](double low, double high, std::size_t axis, double& from, double& to) {
      from = low + (high - low) * fraction(axis);
      to = low + (high - low) * (fraction(axis) + 1 / parts);
    };
    split(region->west, east, 0, part.west, part.east);
    split(region->south, region->north, 1, part.south, part.north);
    if (is_octree) split(region->low, region->high, 2, part.low, part.high);
    return part;
  }
  return Everywhere{};
}

std::string ImplicitTree::uri_of(const std::string& pattern, const TileIndex& index) const {
  std::string uri = pattern;
  // Braces may be written as RFC 3986 demands.
  const std::array<std::pair<const char*, const char*>, 4> codes = {
      {{"%7B", "{"}, {"%7b", "{"}, {"%7D", "}"}, {"%7d", "}"}}};
  for (const auto& [code, brace] : codes) {
    for (std::size_t at = uri.find(code); at != std::string::npos; at = uri.find(code, at)) uri.replace(at, 3, brace);
  }
  const std::array<std::pair<const char*, std::uint64_t>, 4> values = {
      {{"{level}", index.level}, {"{x}", index.at[0]}, {"{y}", index.at[1]}, {"{z}", index.at[2]}}};
  for (const auto& [name, value] : values) {
    for (std::size_t at = uri.find(name); at != std::string::npos; at = uri.find(name, at)) {
      uri.replace(at, std::strlen(name), std::to_string(value));
    }
  }
  return uri;
}

std::uint64_t morton_of(const TileIndex& index, std::uint32_t levels, bool is_octree) {
  const std::uint32_t axes = is_octree ? 3 : 2;
  std::uint64_t number = 0;
  for (std::uint32_t bit = 0; bit < levels; ++bit) {
    for (std::uint32_t axis = 0; axis < axes; ++axis) {
      number |= (index.at[axis] >> bit & 1U) << (bit * axes + axis);
    }
  }
  return number;
}

}  // namespace vantage::internal::tiles
