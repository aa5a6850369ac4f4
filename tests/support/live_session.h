// A session of the page, asked as the page asks.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "live/map_areas.h"
#include "live/request.h"
#include "live/session.h"
#include "support/cli_fixture.h"

namespace vantage::live {

using Json = nlohmann::json;

inline constexpr const char* kSquare =
    "target: {name: square, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]}\nsensor: {max_range: 60}\n";

class LiveSession : public testing::Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    session_.open_file(folder_ / "mission.yaml");
  }

  /// The header of an answer, and the bytes after it.
  struct Message {
    Json header;
    std::string rest;
  };
  Message ask(const Json& request) {
    const std::string text = answer(session_, areas_, parse_request(Json{{"id", 7}, {"request", request}}.dump()));
    std::uint32_t length = 0;
    std::memcpy(&length, text.data(), sizeof length);
    EXPECT_EQ(length % 4, 0u);  // arrays begin where their numbers may lie
    return {Json::parse(text.substr(4, length)), text.substr(4 + length)};
  }
  std::string code_of(const Json& request) { return ask(request).header.value("/error/code"_json_pointer, ""); }

  Session session_;
  MapAreas areas_;
};

}  // namespace vantage::live
