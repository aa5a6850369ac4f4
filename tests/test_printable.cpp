// Text from files on its way to a terminal.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/input.h"
#include "common/shown_address.h"
#include "core/text.h"
#include "support/internals.h"
#include "support/random.h"
#include "vantage/error.h"
#include "vantage/scene.h"

namespace vantage {
namespace {

TEST(Printable, LeavesWordsAsTheyAre) {
  for (const char* const text : {"", "plain", "Gr\u00fc\u00dfe, 12 m\u00b2", "\u6771\u4eac",
                                 "\u0645\u0628\u0646\u0649 \u200f\u05d1", "\U0001f3db"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(core::escaped_json(text), text);
  }
}

TEST(Printable, TakesAwayWhatATerminalObeys) {
  EXPECT_EQ(printable("\x1b[31mred\x1b[0m"), " [31mred [0m");
  EXPECT_EQ(printable(std::string("a\0b\nc\td\x7f", 8)), "a b c d ");
  EXPECT_EQ(printable("a\u009b31m"), "a 31m");  // C1: a CSI in one character
  EXPECT_EQ(printable("\u202eexe.\u2066b\u2028c"), "\ufffdexe.\ufffdb\ufffdc");
  EXPECT_EQ(printable("caf\xe9"), "caf\u00e9");  // Latin-1
  EXPECT_EQ(printable("a\x9b"
                      "31m\xe2\x80"),
            "a 31m\u00e2 ");  // a C1 byte, and a character that is cut off
}

TEST(Printable, AddressesAreCutToWhatIsNoSecret) {
  for (const auto& [address, shown] : std::vector<std::pair<std::string, std::string>>{
           {"https://me:secret@a.example:8/t@1.json?key=1#x", "https://a.example:8/t@1.json"},
           {"https://me:p@ss@a.example/t.json", "https://a.example/t.json"},
           {"https://me%3Asecret%40a.example/t.json", "https://a.example/t.json"},
           {"https://a.example/t.json%3fkey=secret", "https://a.example/t.json"},
           {"https://a.example/t.json&key=secret", "https://a.example/t.json"},
           {"https://a.example/t.json%26key=secret", "https://a.example/t.json"},
           {"https://a.example/t.json;key=secret", "https://a.example/t.json"},
           {"https://me:top?secret@a.example/x", "https://"},
           {"https://me:top/secret@a.example/x", "https://"},
           {"https://me:secr", "https://"},  // cut off by others
           {"https://a.example?user=me@b.example&key=secret", "https://"},
           {"https://a.example/x?user=me@b.example&key=secret", "https://a.example/x"},
           {"http://me:secret@[::1]:80/x", "http://[::1]:80/x"},
           {"ftp://me:secret@a.example/x", "ftp://a.example/x"},
           {"s3://me:secret@bucket/x", "s3://bucket/x"},
           {"http:/me:secret@a.example/x", "http:/a.example/x"},
           {"http:\\\\me:secret@a.example\\x", "http:\\\\a.example\\x"},
           {" http://m\ne:secret@a.example/x", " http://a.example/x"},
           {"//me:secret@a.example/x", "//a.example/x"},
           {"/data/http:/me:secret@a.example/x?key=1", "/data/http:/a.example/x"},
           {"zip://a.osm::https://me:secret@a.example/a.zip?key=1", "zip://a.osm::https://a.example/a.zip"},
           {"s3://bucket/a@b.osm", "s3://bucket/a@b.osm"},
           {"https//a.example/t.json?key=secret", "https//a.example/t.json"},
           {"https//me:secret@a.example/t.json", "https//a.example/t.json"},
           {"http:a.example/t.json?key=secret", "http:a.example/t.json"},
           {"http ://me:secret@a.example/x?key=1", "http ://a.example/x"},
           {"x://me:secret@a.example/x?key=1", "x://a.example/x"},
           {"me:secret@a.example/t.json", "a.example/t.json"},
           {"me:s@secret@a.example?key=1", "a.example"},
           {"me%3asecret%40a.example/t.json", "a.example/t.json"},
           {"me:secret?x@a.example/t.json", ""},
           {"127.0.0.1:1/a?key=secret", "127.0.0.1:1/a"},
           {"127.0.0.1:1/a?to=me:b@secret", "127.0.0.1:1/"},
           {"tiles/miss.glb;key=secret", "tiles/miss.glb"},
           {"miss.glb%3bkey=secret/", "miss.glb"},
           {"C:\\data\\a@b?.osm", "C:\\data\\a@b?.osm"},
           {"C:\\me@home\\a;b.osm", "C:\\me@home\\a;b.osm"},
           {"/data/a=1/me@home.osm", "/data/a=1/me@home.osm"},
           {"/me@home/mission.yaml:4:32, a/b? c=d", "/me@home/mission.yaml:4:32, a/b? c=d"},
           {"/data/me@home/a&b?.osm", "/data/me@home/a&b?.osm"}}) {
    EXPECT_EQ(without_secrets(address, true), shown);
    const Error error(ErrorCode::file_not_found, "no file " + in_quotes(address) + ", is there?", address, "");
    EXPECT_EQ(std::string(error.what()).find("secr"), std::string::npos) << error.what();
    EXPECT_TRUE(error.problem().ends_with("', is there?")) << error.problem();
  }
  EXPECT_EQ(without_secrets("at 'http://me:secret@a.example/x?key=1' & me@b.org; why? http://c.example/?k"),
            "at 'http://a.example/x' & me@b.org; why? http://c.example/");
  EXPECT_EQ(without_secrets("'h/a?key=secret', \"me:secret@h\"; ? a.b;c=secret, on"), "'h/a', \"h\"; ? a.b, on");
  EXPECT_EQ(without_secrets("why? At a:/b"), "why? At a:/b");
  const std::string many(100'000, '/');
  EXPECT_EQ(without_secrets(many).size(), many.size());
  std::string marks;
  for (int i = 0; i < 50'000; ++i) marks += "/?";
  EXPECT_EQ(without_secrets(marks), marks);
}

TEST(Printable, EveryByteIsHarmlessAndUtf8) {
  testing::Random random(7);
  const std::vector<std::string> pieces = {"\xe2\x80", "\xe2\x81", "\xae", "\xa6",     "\xc2",
                                           "\x9b",     "\x1b",     "a",    "\xf0\x9f", "\n"};
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (int n = random.integer(0, 8); n > 0; --n) {
      text += random.chance(0.3) ? std::string(1, static_cast<char>(random.integer(0, 255)))
                                 : pieces[static_cast<std::size_t>(random.integer(0, 9))];
    }
    const std::string shown = printable(text);
    EXPECT_EQ(printable(shown), shown);
    const std::string json = nlohmann::json(shown).dump();  // throws for what is no UTF-8
    EXPECT_EQ(json,
              '"' + (shown.find_first_of("\"\\") == std::string::npos ? shown : json.substr(1, json.size() - 2)) + '"');
    EXPECT_EQ(core::escaped_json(json), json);
  }
}

TEST(Printable, JsonKeepsWhatItEscapes) {
  testing::Random random(8);
  const std::vector<std::string> pieces = {"\u202e", "\u2069", "\u2028", "\u009b", "\x7f", "\x1b",
                                           "\n",     "\u00e9", "\u2027", "\u206a", "x"};
  for (int i = 0; i < 2000; ++i) {
    std::string text;
    for (int n = random.integer(0, 6); n > 0; --n) text += pieces[static_cast<std::size_t>(random.integer(0, 10))];
    const std::string json = core::escaped_json(nlohmann::json(text).dump());
    EXPECT_EQ(nlohmann::json::parse(json).get<std::string>(), text);
    EXPECT_EQ(printable(json), json);
  }
}

TEST(Printable, ErrorsAndNamesOfObjectsAreSo) {
  const Error error(ErrorCode::value_syntax, "no \x1b[2J\nfake", "a\nb", "\u202edo");
  EXPECT_EQ(error.problem(), "no  [2J fake");
  EXPECT_STREQ(error.what(), "no  [2J fake\na b\n\ufffddo");
  EXPECT_EQ(message_of(error), "no  [2J fake\n  where: a b\n  what to do: \ufffddo\n");
  EXPECT_EQ(display_name({"\x1b[31mhouse", "way/\n1", ObjectKind::building}), "way/ 1  [31mhouse");
}

}  // namespace
}  // namespace vantage
