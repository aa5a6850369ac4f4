#include "maps/osm/pbf_block.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <osmium/io/detail/protobuf_tags.hpp>
#include <protozero/pbf_message.hpp>
#include <string>
#include <vector>

#include "maps/osm/refused_input.h"

namespace vantage::internal::osm {
namespace {

namespace format = osmium::io::detail::OSMFormat;
using protozero::pbf_wire_type;
using protozero::tag_and_type;

// The sizes of libosmium's objects, rounded up: an object with its user's name and the heads of its lists, a node of a
// way, a member without its role.
constexpr std::uint64_t kObject = 96, kWayNode = 16, kMember = 24;

class BlockSize {
 public:
  explicit BlockSize(protozero::data_view block) : block_(block) {}

  std::uint64_t measure() {
    protozero::pbf_message<format::PrimitiveBlock> block(block_);
    while (block.next()) {
      switch (block.tag_and_type()) {
        case tag_and_type(format::PrimitiveBlock::required_StringTable_stringtable, pbf_wire_type::length_delimited):
          read_texts(block.get_view());
          break;
        case tag_and_type(format::PrimitiveBlock::optional_int32_granularity, pbf_wire_type::varint):
          most_ = kMost / std::max<std::int64_t>(1, std::abs(static_cast<std::int64_t>(block.get_int32())));
          break;
        case tag_and_type(format::PrimitiveBlock::optional_int64_lat_offset, pbf_wire_type::varint):
        case tag_and_type(format::PrimitiveBlock::optional_int64_lon_offset, pbf_wire_type::varint):
          check_steps(std::array{block.get_int64()}, kMost);
          break;
        default:
          block.skip();
      }
    }
    protozero::pbf_message<format::PrimitiveBlock> again(block_);
    while (
        again.next(format::PrimitiveBlock::repeated_PrimitiveGroup_primitivegroup, pbf_wire_type::length_delimited)) {
      measure_group(again.get_view());
    }
    return size_;
  }

 private:
  void read_texts(protozero::data_view table) {
    protozero::pbf_message<format::StringTable> texts(table);
    while (texts.next(format::StringTable::repeated_bytes_s, pbf_wire_type::length_delimited)) {
      const protozero::data_view text = texts.get_view();
      if (text.size() > 0 && std::memchr(text.data(), 0, text.size()) != nullptr) {
        throw RefusedInput(ErrorCode::map_syntax, "a text of the map, a tag or a name, holds a NUL byte",
                           "text " + std::to_string(lengths_.size()), "download or export the map again");
      }
      lengths_.push_back(text.size());
    }
  }

  /// Numbers of which each is the difference to the one before. libosmium multiplies positions and adds to them, and
  /// trusts that no number overflows.
  template <class Range>
  static void check_steps(const Range& steps, std::int64_t most) {
    std::int64_t sum = 0;
    for (const std::int64_t step : steps) {
      const bool is_step = -most <= step && step <= most;
      sum += is_step ? step : 0;
      if (is_step && -most <= sum && sum <= most) continue;
      throw RefusedInput(ErrorCode::map_syntax, "a position of the map is not on the earth, nor near it",
                         "a block of nodes", "download or export the map again");
    }
  }

  /// With its NUL. What is out of range is refused later, by libosmium.
  std::uint64_t length(std::uint64_t text) const { return text < lengths_.size() ? lengths_[text] + 1 : 1; }

  template <class Range>
  void add_texts(const Range& texts) {
    for (const auto text : texts) size_ += length(static_cast<std::uint64_t>(text));
  }

  void measure_group(protozero::data_view group_data) {
    protozero::pbf_message<format::PrimitiveGroup> group(group_data);
    while (group.next()) {
      switch (group.tag_and_type()) {
        case tag_and_type(format::PrimitiveGroup::repeated_Node_nodes, pbf_wire_type::length_delimited):
          measure_node(group.get_view());
          break;
        case tag_and_type(format::PrimitiveGroup::optional_DenseNodes_dense, pbf_wire_type::length_delimited):
          measure_dense(group.get_view());
          break;
        case tag_and_type(format::PrimitiveGroup::repeated_Way_ways, pbf_wire_type::length_delimited):
          measure_way(group.get_view());
          break;
        case tag_and_type(format::PrimitiveGroup::repeated_Relation_relations, pbf_wire_type::length_delimited):
          measure_relation(group.get_view());
          break;
        default:
          group.skip();
      }
    }
  }

  void measure_user(protozero::data_view info_data) {
    protozero::pbf_message<format::Info> info(info_data);
    while (info.next(format::Info::optional_uint32_user_sid, pbf_wire_type::varint)) size_ += length(info.get_uint32());
  }

  void measure_node(protozero::data_view data) {
    size_ += kObject;
    protozero::pbf_message<format::Node> node(data);
    while (node.next()) {
      switch (node.tag_and_type()) {
        case tag_and_type(format::Node::packed_uint32_keys, pbf_wire_type::length_delimited):
        case tag_and_type(format::Node::packed_uint32_vals, pbf_wire_type::length_delimited):
          add_texts(node.get_packed_uint32());
          break;
        case tag_and_type(format::Node::optional_Info_info, pbf_wire_type::length_delimited):
          measure_user(node.get_view());
          break;
        case tag_and_type(format::Node::required_sint64_lat, pbf_wire_type::varint):
        case tag_and_type(format::Node::required_sint64_lon, pbf_wire_type::varint):
          check_steps(std::array{node.get_sint64()}, most_);
          break;
        default:
          node.skip();
      }
    }
  }

  void measure_dense(protozero::data_view data) {
    protozero::pbf_message<format::DenseNodes> dense(data);
    while (dense.next()) {
      switch (dense.tag_and_type()) {
        case tag_and_type(format::DenseNodes::packed_sint64_id, pbf_wire_type::length_delimited):
          size_ += kObject * dense.get_packed_sint64().size();
          break;
        case tag_and_type(format::DenseNodes::packed_sint64_lat, pbf_wire_type::length_delimited):
        case tag_and_type(format::DenseNodes::packed_sint64_lon, pbf_wire_type::length_delimited):
          check_steps(dense.get_packed_sint64(), most_);
          break;
        case tag_and_type(format::DenseNodes::packed_int32_keys_vals, pbf_wire_type::length_delimited):
          for (const std::int32_t text : dense.get_packed_int32()) {
            if (text > 0) size_ += length(static_cast<std::uint64_t>(text));
          }
          break;
        case tag_and_type(format::DenseNodes::optional_DenseInfo_denseinfo, pbf_wire_type::length_delimited):
          measure_dense_users(dense.get_view());
          break;
        default:
          dense.skip();
      }
    }
  }

  void measure_dense_users(protozero::data_view data) {
    protozero::pbf_message<format::DenseInfo> info(data);
    while (info.next(format::DenseInfo::packed_sint32_user_sid, pbf_wire_type::length_delimited)) {
      std::uint64_t text = 0;  // each is the difference to the one before
      for (const std::int32_t step : info.get_packed_sint32()) {
        text += static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
        size_ += length(text);
      }
    }
  }

  void measure_way(protozero::data_view data) {
    size_ += kObject;
    protozero::pbf_message<format::Way> way(data);
    while (way.next()) {
      switch (way.tag_and_type()) {
        case tag_and_type(format::Way::packed_uint32_keys, pbf_wire_type::length_delimited):
        case tag_and_type(format::Way::packed_uint32_vals, pbf_wire_type::length_delimited):
          add_texts(way.get_packed_uint32());
          break;
        case tag_and_type(format::Way::packed_sint64_refs, pbf_wire_type::length_delimited):
          size_ += kWayNode * way.get_packed_sint64().size();
          break;
        case tag_and_type(format::Way::packed_sint64_lat, pbf_wire_type::length_delimited):
        case tag_and_type(format::Way::packed_sint64_lon, pbf_wire_type::length_delimited):
          check_steps(way.get_packed_sint64(), most_);
          break;
        case tag_and_type(format::Way::optional_Info_info, pbf_wire_type::length_delimited):
          measure_user(way.get_view());
          break;
        default:
          way.skip();
      }
    }
  }

  void measure_relation(protozero::data_view data) {
    size_ += kObject;
    protozero::pbf_message<format::Relation> relation(data);
    while (relation.next()) {
      switch (relation.tag_and_type()) {
        case tag_and_type(format::Relation::packed_uint32_keys, pbf_wire_type::length_delimited):
        case tag_and_type(format::Relation::packed_uint32_vals, pbf_wire_type::length_delimited):
          add_texts(relation.get_packed_uint32());
          break;
        case tag_and_type(format::Relation::packed_int32_roles_sid, pbf_wire_type::length_delimited):
          for (const std::int32_t role : relation.get_packed_int32()) {
            size_ += kMember + length(static_cast<std::uint64_t>(static_cast<std::int64_t>(role)));
          }
          break;
        case tag_and_type(format::Relation::optional_Info_info, pbf_wire_type::length_delimited):
          measure_user(relation.get_view());
          break;
        default:
          relation.skip();
      }
    }
  }

  protozero::data_view block_;
  std::vector<std::uint64_t> lengths_;  // of the texts of the block
  std::uint64_t size_ = 0;
  static constexpr std::int64_t kMost = std::int64_t{1} << 61;
  std::int64_t most_ = kMost / 100;  // of a position: times the block's granularity it is no more than kMost
};

}  // namespace

std::uint64_t unpacked_size(std::string_view block) { return BlockSize({block.data(), block.size()}).measure(); }

}  // namespace vantage::internal::osm
