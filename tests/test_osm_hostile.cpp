// Maps that were made to harm: what a reader may not follow beyond its memory, and what is refused before it fills it.
#include <bzlib.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <osmium/builder/osm_object_builder.hpp>
#include <string>
#include <vector>

#include "maps/osm/map_objects.h"
#include "maps/osm/pbf_file.h"
#include "maps/osm/refused_input.h"
#include "maps/osm/text_input.h"
#include "maps/osm/xml_bounds.h"
#include "support/osm_maps.h"
#include "support/pbf_writer.h"
#include "support/random.h"
#include "support/wording.h"

namespace vantage::internal::osm {
namespace {

using testing::pbf_block;
using testing::pbf_field;
using testing::pbf_header;
using testing::pbf_packed;
using testing::pbf_packed_signed;
using testing::TemporaryDirectory;
using testing::write_bytes;

using Texts = std::vector<std::string>;

constexpr std::int64_t kUnits = 10'000'000;  // of a degree, in a PBF with its usual granularity

const Texts kTexts = {"", "building", "yes", "outer", "type", "multipolygon", "someone"};

std::string house_corners(const std::string& more = "") {
  return pbf_field(2, pbf_field(1, pbf_packed_signed({1, 1, 1, 1})) +
                          pbf_field(8, pbf_packed_signed({47 * kUnits, 0, 10000, 0})) +
                          pbf_field(9, pbf_packed_signed({8 * kUnits, 10000, 0, -10000})) + more);
}

std::string house(const std::string& more = "") {
  return pbf_field(3, pbf_field(1, 10) + pbf_field(8, pbf_packed_signed({1, 1, 1, 1, -3})) + more);
}

const std::string kBuildingTags = pbf_field(2, pbf_packed({1})) + pbf_field(3, pbf_packed({2}));

std::string relation() {
  return pbf_field(4, pbf_field(1, 20) + pbf_field(2, pbf_packed({4, 1})) + pbf_field(3, pbf_packed({5, 2})) +
                          pbf_field(8, pbf_packed({3})) + pbf_field(9, pbf_packed_signed({10})) +
                          pbf_field(10, pbf_packed({1})));
}

std::string simple_node() {  // not dense
  return pbf_field(1, pbf_field(1, std::uint64_t{2 * 77}) + kBuildingTags +
                          pbf_field(4, pbf_field(5, std::uint64_t{6})) +
                          pbf_field(8, static_cast<std::uint64_t>(2 * 47 * kUnits)) +
                          pbf_field(9, static_cast<std::uint64_t>(2 * 8 * kUnits)));
}

std::string whole_map(const Texts& texts) {
  const std::string info = pbf_field(5, pbf_field(5, pbf_packed_signed({6, 0, 0, 0})));
  const std::string tags = pbf_field(10, pbf_packed({1, 2, 0, 0, 0, 0}));
  return pbf_header() + pbf_block(texts, {house_corners(info + tags), simple_node(), house(kBuildingTags), relation()});
}

class OsmHostile : public ::testing::Test {
 protected:
  Error refused(const std::string& bytes, ErrorCode code, const std::string& where) {
    write_bytes(file_, bytes);
    return testing::expect_error([this] { read_extract(file_); }, code, where);
  }
  Extract extract(const std::string& bytes) {
    write_bytes(file_, bytes);
    return read_extract(file_);
  }

  TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "map.osm";
};

TEST_F(OsmHostile, AMapWrittenByHandIsRead) {
  const Extract extract = this->extract(whole_map(kTexts));
  EXPECT_EQ(extract.nodes, 5u);
  ASSERT_EQ(extract.areas.size(), 1u);
  EXPECT_EQ(extract.areas[0].tags.get("building"), "yes");
  EXPECT_EQ(extract.points.size(), 2u);
  EXPECT_NEAR(extract.areas[0].polygons.at(0).outer.at(0).latitude_deg, 47, 1e-9);
}

TEST_F(OsmHostile, ANulByteInAnyTextIsRefused) {
  // Every text of the map: keys and values of nodes, of ways and of relations, roles of members, names of users.
  for (std::size_t i = 0; i < kTexts.size(); ++i) {
    for (const std::size_t at : {std::size_t{0}, kTexts[i].size() / 2, kTexts[i].size()}) {
      SCOPED_TRACE(kTexts[i] + " with a NUL at " + std::to_string(at));
      Texts texts = kTexts;
      texts[i].insert(at, 1, '\0');
      write_bytes(file_, whole_map(texts));
      testing::expect_code([this] { read_extract(file_); }, ErrorCode::map_syntax, "block at byte 57");
    }
  }
  Texts texts = kTexts;
  texts[1] = std::string("a\0b", 3);
  refused(whole_map(texts), ErrorCode::map_syntax, "block at byte");
}

/// libosmium multiplies them by the granularity, in 64 bits.
TEST_F(OsmHostile, PositionsThatOverflowAreRefused) {
  constexpr std::int64_t kFar = std::int64_t{1} << 61, kMost = kFar / 100;
  const auto map = [](const std::vector<std::int64_t>& latitudes, const std::string& more = "") {
    const std::vector<std::int64_t> zeros(latitudes.size(), 0);
    return pbf_header() +
           testing::pbf_raw_block(pbf_field(1, pbf_field(1, "")) +
                                  pbf_field(2, pbf_field(2, pbf_field(1, pbf_packed_signed(zeros)) +
                                                                pbf_field(8, pbf_packed_signed(latitudes)) +
                                                                pbf_field(9, pbf_packed_signed(zeros)))) +
                                  more);
  };
  EXPECT_EQ(extract(map({kMost, -kMost})).nodes, 1U);
  for (const std::vector<std::int64_t>& steps :
       {std::vector<std::int64_t>{kMost + 1}, {-kMost - 1}, {kMost, 1}, {INT64_MAX}, {INT64_MIN}, {1, INT64_MAX}}) {
    refused(map(steps), ErrorCode::map_syntax, "block at byte 57");
  }
  refused(map({kMost}, pbf_field(17, std::uint64_t{1000})), ErrorCode::map_syntax, "block at byte 57");
  refused(map({0}, pbf_field(19, static_cast<std::uint64_t>(INT64_MAX))), ErrorCode::map_syntax, "block at byte 57");
}

TEST_F(OsmHostile, TagsEndWithTheirList) {
  // As libosmium keeps them where a text holds a NUL byte: a text more than keys and values make.
  for (const std::size_t nuls : {1, 2, 3}) {
    osmium::memory::Buffer buffer(1024, osmium::memory::Buffer::auto_grow::yes);
    {
      osmium::builder::TagListBuilder builder(buffer);
      const std::string key = "a" + std::string(nuls, '\0') + "b";
      builder.add_tag(key.data(), key.size(), "value", 5);
    }
    buffer.commit();
    const Tags tags = to_tags(buffer.get<osmium::TagList>(0));
    EXPECT_EQ(tags.all.size(), (nuls + 3) / 2);
    EXPECT_TRUE(tags.has("a"));
  }
}

TEST_F(OsmHostile, BlocksThatUnpackToTooMuchAreRefused) {
  const std::string tag(1000, 'k');
  const std::size_t many = kMostOfBlock / 2000 + 1000;
  const auto repeated = [](char number, std::size_t count) { return std::string(count, number); };
  // One way with tags, one relation with members: libosmium counts the bytes of an object in 32 bits.
  const std::string way =
      pbf_field(3, pbf_field(1, std::uint64_t{1}) + pbf_field(2, repeated(1, many)) + pbf_field(3, repeated(1, many)));
  refused(pbf_header() + pbf_block({"", tag}, {way}), ErrorCode::file_too_large, "block at byte 57");
  const std::string members =
      pbf_field(4, pbf_field(1, std::uint64_t{1}) + pbf_field(8, repeated(1, 2 * many)) +
                       pbf_field(9, repeated(2, 2 * many)) + pbf_field(10, repeated(1, 2 * many)));
  refused(pbf_header() + pbf_block({"", tag}, {members}), ErrorCode::file_too_large, "block at byte 57");
  // Names of users: of nodes, whose bytes are few.
  const std::size_t nodes = kMostOfBlock / 1000;
  std::string users = repeated(0, nodes);
  users[0] = 2;
  const std::string dense = pbf_field(2, pbf_field(1, repeated(2, nodes)) + pbf_field(8, repeated(2, nodes)) +
                                             pbf_field(9, repeated(2, nodes)) + pbf_field(5, pbf_field(5, users)));
  refused(pbf_header() + pbf_block({"", tag}, {dense}), ErrorCode::file_too_large, "block at byte 57");
}

TEST_F(OsmHostile, AFileThatUnpacksToTooMuchIsRefused) {
  const std::size_t nodes = 1 << 18;
  const std::string column(nodes, 2);
  const std::string block =
      pbf_block({""}, {pbf_field(2, pbf_field(1, column) + pbf_field(8, column) + pbf_field(9, column))});
  std::string bytes = pbf_header();
  for (std::uint64_t unpacked = 0; unpacked < most_of_pbf(bytes.size()); unpacked += 80 * nodes) bytes += block;
  EXPECT_LT(bytes.size(), 1u << 20U);
  refused(bytes, ErrorCode::file_too_large, "block at byte");
}

std::string gzipped(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, MAX_WBITS + 16, 9, Z_DEFAULT_STRATEGY);
  std::string bytes(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  bytes.resize(stream.total_out);
  deflateEnd(&stream);
  return bytes;
}

std::string bzip2ed(const std::string& text) {
  auto size = static_cast<unsigned>(text.size() + text.size() / 50 + 600);
  std::string bytes(size, '\0');
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(bytes.data(), &size, const_cast<char*>(text.data()),
                                     static_cast<unsigned>(text.size()), 9, 0, 0),
            BZ_OK);
  bytes.resize(size);
  return bytes;
}

const std::string kXmlHouse =
    testing::osm_xml(testing::osm_square(1, 8.5, 47.25, 0.001) +
                     testing::osm_way(10, testing::osm_ring(1), testing::osm_tag("building", "yes")));

TEST_F(OsmHostile, PackedTextsOfSeveralPartsAreRead) {
  const std::size_t half = kXmlHouse.size() / 2;
  const std::string first = kXmlHouse.substr(0, half), second = kXmlHouse.substr(half);
  for (const std::string& bytes :
       {gzipped(kXmlHouse), gzipped(first) + gzipped(second), gzipped(first) + gzipped("") + gzipped(second),
        gzipped(kXmlHouse) + std::string(512, '\0'), bzip2ed(kXmlHouse), bzip2ed(first) + bzip2ed(second)}) {
    EXPECT_EQ(extract(bytes).areas.size(), 1u);
  }
  write_bytes(file_, gzipped(kXmlHouse) + "garbage");
  testing::expect_code([this] { read_extract(file_); }, ErrorCode::compression_broken, "byte");
  write_bytes(file_, gzipped(first) + gzipped(second).substr(0, 20));
  testing::expect_code([this] { read_extract(file_); }, ErrorCode::compression_broken, "byte");
  write_bytes(file_, bzip2ed(first) + bzip2ed(second).substr(0, 20));
  testing::expect_code([this] { read_extract(file_); }, ErrorCode::compression_broken, "byte");
}

TEST_F(OsmHostile, TextsThatUnpackToTooMuchAreRefused) {
  const std::string blanks(std::size_t{1} << 24U, ' ');
  const std::string begin = "<osm version=\"0.6\">";
  std::string gzip = gzipped(begin), bzip2 = bzip2ed(begin);
  const std::string gzip_part = gzipped(blanks), bzip2_part = bzip2ed(blanks);
  for (int i = 0; i < 40; ++i) {
    gzip += gzip_part;
    bzip2 += bzip2_part;
  }
  ASSERT_GT(40 * blanks.size(), most_unpacked(gzip.size()));
  write_bytes(file_, gzip);
  testing::expect_code([this] { read_extract(file_); }, ErrorCode::file_too_large, "map.osm");
  refused(bzip2, ErrorCode::file_too_large, "map.osm");
}

TEST_F(OsmHostile, APackedTextMustBeAMap) {
  refused(gzipped("<gpx/>"), ErrorCode::map_format_unknown, "map.osm");
  refused(gzipped("<?xml version='1.0'?><!DOCTYPE osm [<!ENTITY a 'b'>]><osm version='0.6'>&a;</osm>"),
          ErrorCode::map_format_unknown, "map.osm");
  // UTF-16: bounds would be looked for in vain.
  std::string wide = "\xff\xfe";
  for (const char c : kXmlHouse) (wide += c) += '\0';
  refused(gzipped(wide), ErrorCode::map_format_unknown, "map.osm");
}

TEST_F(OsmHostile, LongTagsAreRefusedEarly) {
  const std::string long_text(XmlBounds::kMostOfTag + 100, 'A');
  const std::string begin = "<osm version='0.6'><node id='1' lat='48' lon='11'>";
  refused(begin + "<tag k='name' v='" + long_text + "'/></node></osm>", ErrorCode::map_syntax, "byte 50 of the XML");
  refused(begin + "<!--" + long_text + "></osm>", ErrorCode::map_syntax, "byte 50 of the XML");
  refused(begin + "<?" + long_text + "?></osm>", ErrorCode::map_syntax, "byte 50 of the XML");
}

TEST_F(OsmHostile, LargeObjectsAreRefused) {
  std::string nodes;
  while (nodes.size() < XmlBounds::kMostOfObject) nodes += "<nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/>\n";
  refused("<osm version='0.6'><way id='1'>" + nodes + "</way></osm>", ErrorCode::map_syntax, "byte 19 of the XML");
}

/// Neither what comments, attributes and character data hold nor where the text is cut into parts may mislead.
TEST(XmlBounds, FollowTheMarkupInAnyParts) {
  testing::Random random(5);
  const std::string object =
      "<node id='>' a=\"'/>\"><!-- <way> -- > ' --><tag k='\"' v='<'/><![CDATA[<a> ]] > ]]]]><?pi > ' ?></node\n>"
      "<way/><!----><relation x='a/'></relation> text ";
  std::string objects;
  while (objects.size() < 200'000) objects += object;
  const auto pass = [&](XmlBounds& bounds, const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
      const int count = random.integer(1, random.chance(0.1) ? 100'000 : 7);
      bounds.add(std::string_view(text).substr(at, static_cast<std::size_t>(count)));
      at += static_cast<std::size_t>(count);
    }
  };
  // If one tag or object were taken for open, all that follows would be too long.
  XmlBounds bounds;
  pass(bounds, "<?xml version='1.0'?>\n<osm version='0.6'>" + objects);
  for (std::uint64_t passed = 0; passed < 2 * XmlBounds::kMostOfObject; passed += objects.size()) bounds.add(objects);
  pass(bounds, objects + "<way id='1'>");
  const std::string filler(1 << 16, ' ');
  const auto fill = [&] {
    for (std::uint64_t passed = 0; passed < XmlBounds::kMostOfObject; passed += filler.size()) bounds.add(filler);
  };
  EXPECT_THROW(fill(), RefusedInput);
}

}  // namespace
}  // namespace vantage::internal::osm
