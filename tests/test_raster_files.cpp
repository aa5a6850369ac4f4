// Which files are read as rasters, and that nothing but the file is: no other file, and no network.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "maps/terrain/gdal_library.h"
#include "maps/terrain/height_grid.h"
#include "maps/terrain/raster_file.h"
#include "support/pipe.h"
#include "support/raster_writer.h"
#include "support/temporary_directory.h"
#include "support/wording.h"

namespace vantage::internal::terrain {
namespace {

namespace fs = std::filesystem;
using testing::convert_raster;
using testing::make_raster;
using testing::TemporaryDirectory;
using testing::write_bytes;
using testing::write_raster;

testing::TestRaster small_raster() {
  return make_raster(20, 20, [](int column, int row) { return 100 + column - 2 * row; });
}

void expect_unread(const fs::path& file) {
  testing::expect_code([&] { read_height_grid(file); }, ErrorCode::raster_unreadable, file.filename().string());
}

/// A port of this machine where somebody listens and does not answer: whether anybody came.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_, 8), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
    ::fcntl(socket_, F_SETFL, O_NONBLOCK);
    gdal({}).CPLSetThreadLocalConfigOption("GDAL_HTTP_TIMEOUT", "1");  // for who comes all the same
  }
  ~Listener() {
    gdal({}).CPLSetThreadLocalConfigOption("GDAL_HTTP_TIMEOUT", nullptr);
    ::close(socket_);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  std::string address() const { return "http://127.0.0.1:" + std::to_string(port_); }
  bool was_called() const {
    const int call = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    if (call >= 0) ::close(call);
    return call >= 0;
  }

 private:
  int socket_;
  int port_ = 0;
};

TEST(RasterFiles, GeoTiffAsciiGridAndSrtmAreRead) {
  const TemporaryDirectory folder;
  const fs::path tif = write_raster(folder.path(), "dem", small_raster());
  const HeightGrid expected = read_height_grid(tif);
  EXPECT_EQ(expected.at(3, 4), 95);
  convert_raster(tif, folder / "grid.asc", "AAIGrid");
  ASSERT_TRUE(fs::exists(folder / "grid.prj"));
  EXPECT_EQ(read_height_grid(folder / "grid.asc").heights_m, expected.heights_m);  // with the system of grid.prj
  fs::rename(folder / "grid.asc", folder / "height.data");                         // told by the content
  fs::rename(folder / "grid.prj", folder / "height.prj");
  EXPECT_EQ(read_height_grid(folder / "height.data").heights_m, expected.heights_m);

  std::string tile(2 * 1201 * 1201, '\0');
  tile[1] = 77;  // the north-west post, big-endian
  write_bytes(folder / "N43E007.hgt", tile);
  EXPECT_EQ(read_height_grid(folder / "N43E007.hgt").at(0, 0), 77);
}

TEST(RasterFiles, AFileMayNotNameOthers) {
  const TemporaryDirectory folder;
  const Listener listener;
  // Any raster, of which somebody else must not see the heights; and a text.
  const fs::path secret = write_raster(folder.path(), "secret", small_raster());
  const std::string head =
      "<VRTDataset rasterXSize=\"20\" rasterYSize=\"20\"><GeoTransform>11,0.0001,0,48,0,-0.0001</GeoTransform>"
      "<SRS>EPSG:4326</SRS><VRTRasterBand dataType=\"Float32\" band=\"1\"";
  const std::string end = "</VRTRasterBand></VRTDataset>";
  const auto simple = [&](const std::string& name) {
    return head + "><SimpleSource><SourceFilename relativeToVRT=\"0\">" + name + "</SourceFilename></SimpleSource>" +
           end;
  };
  const std::string raw = head +
                          " subClass=\"VRTRawRasterBand\"><SourceFilename relativetoVRT=\"0\">/etc/passwd"
                          "</SourceFilename><PixelOffset>1</PixelOffset><LineOffset>20</LineOffset>" +
                          end;
  const std::string wms =
      "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" + listener.address() +
      "/${z}/${x}/${y}.tif</ServerUrl></Service><DataWindow><UpperLeftX>11</UpperLeftX><UpperLeftY>48"
      "</UpperLeftY><LowerRightX>11.01</LowerRightX><LowerRightY>47.99</LowerRightY><SizeX>100</SizeX>"
      "<SizeY>100</SizeY></DataWindow><Projection>EPSG:4326</Projection><BandsCount>1</BandsCount>"
      "<DataType>Float32</DataType></GDAL_WMS>";
  for (const std::string& content :
       {simple(secret.string()), simple("/vsicurl/" + listener.address() + "/secret.tif"), raw, wms}) {
    for (const char* const name : {"dsm.tif", "dsm.vrt", "dsm.asc", "dsm.img", "N43E007.hgt"}) {
      write_bytes(folder / name, content);
      expect_unread(folder / name);
    }
  }
  EXPECT_FALSE(listener.was_called());
  write_bytes(folder / "dsm.tif", "II*");
  expect_unread(folder / "dsm.tif");
  for (const char* const driver : {"HFA", "netCDF"}) {  // read by GDAL, and not here
    const fs::path other = folder / "other";
    try {
      convert_raster(secret, other, driver);
    } catch (const std::runtime_error&) {  // a GDAL without that driver
      continue;
    }
    expect_unread(other);
  }
}

/// Overviews, masks and metadata that lie beside a raster are opened by any driver of GDAL, and may name any file.
TEST(RasterFiles, FilesBesideARasterAreNotOpened) {
  const TemporaryDirectory folder;
  const Listener listener;
  const fs::path file = write_raster(folder.path(), "dem", small_raster());
  const std::vector<float> expected = read_height_grid(file).heights_m;
  const std::string far = "/vsicurl/" + listener.address() + "/secret.tif";
  const std::string virtual_text =
      "<VRTDataset rasterXSize=\"20\" rasterYSize=\"20\"><VRTRasterBand dataType=\"Byte\" band=\"1\"><SimpleSource>"
      "<SourceFilename relativeToVRT=\"0\">" +
      far + "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>";
  write_bytes(file.string() + ".ovr", virtual_text);
  write_bytes(file.string() + ".aux.xml", "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">" +
                                              far + "</MDI></Metadata></PAMDataset>");
  EXPECT_EQ(read_height_grid(file).heights_m, expected);
  // The same within the file.
  convert_raster(file, folder / "inside.tif", "GTiff", "OVERVIEWS|OVERVIEW_FILE=" + far);
  EXPECT_EQ(read_height_grid(folder / "inside.tif").heights_m, expected);

  // A mask says which heights are none. It is not read, and the heights are not without it.
  write_bytes(file.string() + ".msk", virtual_text);
  testing::expect_error([&] { read_height_grid(file); }, ErrorCode::raster_unreadable, "dem.tif");
  EXPECT_FALSE(listener.was_called());
}

/// Opening a pipe that nobody writes to would wait for ever: whoever opens one of these is let go, and noted.
TEST(RasterFiles, PipesBesideARasterAreNotOpened) {
  for (const char* const name : {"dem.tif.aux.xml", "DEM.TIF.aux.xml", "dem.tif.msk"}) {
    const TemporaryDirectory folder;
    const fs::path file = write_raster(folder.path(), "dem", small_raster());
    const testing::Pipe pipe(folder / name);
    testing::expect_error([&] { read_height_grid(file); }, ErrorCode::raster_unreadable, "dem.tif");
    EXPECT_FALSE(pipe.was_opened()) << name;
  }
  const TemporaryDirectory folder;
  const fs::path file = write_raster(folder.path(), "dem", small_raster());
  convert_raster(file, folder / "grid.asc", "AAIGrid");
  std::vector<std::unique_ptr<testing::Pipe>> pipes;
  for (const char* const name :
       {"dem.tif.ovr", "dem.ovr", "dem.tfw", "dem.tifw", "dem.wld", "dem.TAB", "dem.tab", "dem.aux", "dem.rrd",
        "dem.imd", "dem.IMD", "dem.rpb", "dem.RPB", "dem.xml", "dem.XML"}) {
    pipes.push_back(std::make_unique<testing::Pipe>(folder / name));
  }
  EXPECT_EQ(read_height_grid(file).voids, 0u);
  for (const auto& pipe : pipes) EXPECT_FALSE(pipe->was_opened()) << pipe->file();
  // The reference system of a grid has a file of its own.
  EXPECT_EQ(read_height_grid(folder / "grid.asc").voids, 0u);
  fs::remove(folder / "grid.prj");
  for (const char* const name : {"grid.prj", "grid.PRJ"}) {
    const testing::Pipe system(folder / name);
    testing::expect_error([&] { read_height_grid(folder / "grid.asc"); }, ErrorCode::raster_unreadable, "grid.asc");
    EXPECT_FALSE(system.was_opened()) << name;
    fs::remove(folder / name);
  }
}

TEST(RasterFiles, WhatChangesHeightsMayNotLieBeside) {
  const TemporaryDirectory folder;
  const fs::path file = write_raster(folder.path(), "dem", small_raster());
  const fs::path beside = file.string() + ".aux.xml";
  const auto metadata = [](const std::string& text) {
    return "<PAMDataset><PAMRasterBand band=\"1\">" + text + "</PAMRasterBand></PAMDataset>";
  };
  for (const std::string element : {"NoDataValue", "Offset", "Scale", "UnitType"}) {
    write_bytes(beside, metadata(std::string("<").append(element).append(">95</").append(element).append(">")));
    testing::expect_error([&] { read_height_grid(file); }, ErrorCode::raster_unreadable, "dem.tif");
  }
  // Where it lies: GDAL would believe this more than the raster.
  for (const std::string text : {"<SRS>EPSG:32633</SRS>", "<GeoTransform>600000,10,0,5000000,0,-10</GeoTransform>"}) {
    write_bytes(beside, "<PAMDataset>" + text + "</PAMDataset>");
    testing::expect_error([&] { read_height_grid(file); }, ErrorCode::raster_unreadable, "dem.tif");
  }
  write_bytes(beside, metadata("<nodatavalue>95</nodatavalue>"));
  expect_unread(file);
  // Behind what is looked through.
  write_bytes(beside, metadata(std::string(std::size_t{1} << 20U, ' ') + "<NoDataValue>95</NoDataValue>"));
  testing::expect_error([&] { read_height_grid(file); }, ErrorCode::raster_unreadable, "dem.tif");
  fs::remove(beside);
  for (const char* const name : {"DEM.TIF.AUX.XML", "dem.tif.MSK"}) {
    write_bytes(folder / name, metadata("<NoDataValue>95</NoDataValue>"));
    expect_unread(file);
    fs::remove(folder / name);
  }
  // Statistics do not.
  write_bytes(file.string() + ".aux.xml",
              "<PAMDataset><PAMRasterBand band=\"1\"><Metadata><MDI key=\"STATISTICS_MEAN\">95</MDI></Metadata>"
              "</PAMRasterBand></PAMDataset>");
  EXPECT_EQ(read_height_grid(file).voids, 0u);
}

/// A stored (not compressed) archive.
std::string stored_zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string archive, directory;
  const auto add = [](std::string& to, std::uint64_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(number >> (8 * i));
  };
  for (const auto& file : files) {
    const std::string &name = file.first, &content = file.second;
    const std::size_t begin = archive.size();
    const auto head = [&](std::string& to) {
      for (const int number : {20, 0, 0, 0, 0x21}) add(to, static_cast<std::uint64_t>(number), 2);
      add(to, ::crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())), 4);
      for (int sizes = 0; sizes < 2; ++sizes) add(to, content.size(), 4);  // packed and unpacked
      add(to, name.size(), 2);
      add(to, 0, 2);
    };
    archive += "PK\3\4";
    head(archive);
    archive += name + content;
    directory += "PK\1\2";
    add(directory, 20, 2);
    head(directory);
    add(directory, 0, 2);
    add(directory, 0, 2);
    add(directory, 0, 2);
    add(directory, 0, 4);
    add(directory, begin, 4);
    directory += name;
  }
  const std::size_t begin = archive.size();
  archive += directory + "PK\5\6";
  add(archive, 0, 4);
  add(archive, files.size(), 2);
  add(archive, files.size(), 2);
  add(archive, directory.size(), 4);
  add(archive, begin, 4);
  add(archive, 0, 2);
  return archive;
}

TEST(RasterFiles, ArchivesHaveOneRasterAndNothingBesideIt) {
  const TemporaryDirectory folder;
  const fs::path file = write_raster(folder.path(), "dem", small_raster());
  std::ifstream stream(file, std::ios::binary);
  const std::string tif{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const fs::path archive = folder / "dem.zip";
  write_bytes(archive, stored_zip({{"readme.txt", "heights"}, {"dem.tif", tif}}));
  EXPECT_EQ(read_height_grid(archive).heights_m, read_height_grid(file).heights_m);
  // Tiles of SRTM have statistics with them.
  const std::string statistics = "<PAMDataset>\n  <MDI key=\"STATISTICS_MEAN\">95</MDI>\n</PAMDataset>\n";
  write_bytes(archive, stored_zip({{"dem.tif", tif}, {"dem.tif.aux.xml", statistics}}));
  EXPECT_EQ(read_height_grid(archive).heights_m, read_height_grid(file).heights_m);
  const std::string place = "<PAMDataset>\n<SRS>EPSG:32633</SRS></PAMDataset>";
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
           {"dem.tif.aux.xml", place},
           {"DEM.tif.AUX.XML", place},
           {"dem.tif.aux.xml", std::string(5000, '\n') + place},  // behind what is looked through
           {"dem.tif.aux.xml", std::string(20000, ' ') + place},
           {"DEM.TIF.MSK", ""}}) {
    write_bytes(archive, stored_zip({{"dem.tif", tif}, {name, content}}));
    testing::expect_error([&] { read_height_grid(archive); }, ErrorCode::raster_unreadable, "dem.zip");
  }
  write_bytes(archive, stored_zip({{"dem.tif", tif}, {"other.tif", tif}}));
  testing::expect_error([&] { read_height_grid(archive); }, ErrorCode::raster_unreadable, "dem.zip");
}

/// No path on disk begins as GDAL's names for what is no file; and a folder may have such a name.
TEST(RasterFiles, PathsAreNoNamesOfGdal) {
  for (const std::string path : {"/vsicurl/http://a/dem.tif", "/vsizip/dem.zip/dem.tif", "/vsite/dem.tif"}) {
    EXPECT_FALSE(path_on_disk(path).starts_with("/vsi"));
    EXPECT_EQ(fs::path(path_on_disk(path)).lexically_normal(), fs::path(path));
  }
  EXPECT_EQ(path_on_disk("/home/vsi/dem.tif"), "/home/vsi/dem.tif");
}

// The first alone would be read. A second directory of the file, with all that the first one has.
TEST(RasterFiles, AGeoTiffHasOneImage) {
  const TemporaryDirectory folder;
  const fs::path file = write_raster(folder.path(), "dsm", small_raster());
  std::string bytes = testing::read_bytes(file);
  const auto number_at = [&](std::size_t at, int size) {
    std::size_t number = 0;
    for (int i = size; i-- > 0;)
      number = number << 8 | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)));
    return number;
  };
  const std::size_t first = number_at(4, 4), next = first + 2 + 12 * number_at(first, 2);
  ASSERT_EQ(bytes.substr(0, 2), "II");
  ASSERT_EQ(number_at(next, 4), 0U);
  const std::string directory = bytes.substr(first, next + 4 - first);
  for (std::size_t i = 0; i < 4; ++i) bytes[next + i] = static_cast<char>(bytes.size() >> 8 * i & 0xFF);
  write_bytes(file, bytes + directory);
  testing::expect_error([&] { read_height_grid(file); }, ErrorCode::raster_not_heights, "dsm.tif");
}

TEST(RasterFiles, AHeaderAloneIsNoRaster) {
  const TemporaryDirectory folder;
  // Sparse: GDAL gives zeros for what the file does not hold.
  std::string tif("II*\0\x08\0\0\0", 8);
  const auto add = [&tif](std::uint64_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) tif += static_cast<char>(number >> (8 * i));
  };
  struct Tag {
    std::uint16_t tag, type;
    std::uint32_t count, value;
  };
  const std::vector<Tag> tags = {{256, 4, 1, 16000}, {257, 4, 1, 16000}, {258, 3, 1, 32},   {259, 3, 1, 1},
                                 {262, 3, 1, 1},     {273, 4, 1, 0},     {277, 3, 1, 1},    {278, 4, 1, 16000},
                                 {279, 4, 1, 0},     {339, 3, 1, 3},     {33550, 12, 3, 0}, {33922, 12, 6, 24},
                                 {34735, 3, 16, 72}};
  const auto extra = static_cast<std::uint32_t>(8 + 2 + 12 * tags.size() + 4);
  add(tags.size(), 2);
  for (const Tag& tag : tags) {
    add(tag.tag, 2);
    add(tag.type, 2);
    add(tag.count, 4);
    add(tag.tag > 30000 ? extra + tag.value : tag.value, 4);
  }
  add(0, 4);
  const auto add_double = [&](double number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    add(bits, 8);
  };
  for (const double number : {1e-4, 1e-4, 0.0, 0.0, 0.0, 0.0, 11.0, 48.0, 0.0}) add_double(number);
  for (const int key : {1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326}) {
    add(static_cast<std::uint64_t>(key), 2);
  }
  write_bytes(folder / "huge.tif", tif);
  testing::expect_error([&] { read_height_grid(folder / "huge.tif"); }, ErrorCode::raster_too_large, "huge.tif");
  EXPECT_EQ(read_height_pixels(folder / "huge.tif", {0, 0, 40, 30}).at(3, 3), 0);  // a part of it may be read
}

TEST(RasterFiles, OptionsOfTheThreadAreAsBefore) {
  const TemporaryDirectory folder;
  const GdalLibrary& library = gdal(folder.path());
  library.CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "YES");
  const auto option = [&](const char* name) {
    const char* const value = library.CPLGetThreadLocalConfigOption(name, nullptr);
    return std::string(value ? value : "(none)");
  };
  {
    const GdalCalls calls(library);
    EXPECT_EQ(option("GDAL_PAM_ENABLED"), "NO");
    const GdalCalls more(library);
    EXPECT_EQ(option("GDAL_DISABLE_READDIR_ON_OPEN"), "EMPTY_DIR");
  }
  EXPECT_EQ(option("GDAL_PAM_ENABLED"), "YES");
  EXPECT_EQ(option("GDAL_DISABLE_READDIR_ON_OPEN"), "(none)");
  library.CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
}

}  // namespace
}  // namespace vantage::internal::terrain
