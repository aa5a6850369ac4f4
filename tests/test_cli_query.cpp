// `vantage query`: tables of points, and what is answered beside them.

#include "core/stopwatch.h"
#include "support/cli_fixture.h"
#include "support/internals.h"
#include "vantage/georeference.h"

namespace vantage::testing {
namespace {

using CliQuery = Cli;

constexpr const char* kAnswers = "inside,margin_m,blocked_by,out_of_range,behind_target,outside_of";

TEST_F(CliQuery, Answers) {
  write("points.csv", "x,y,z\n0,0,30\n60,0,5\n0,0,80\n0,0,-3\n");
  const std::vector<std::string> rows = lines(output_of({"query", "mission.yaml", "points.csv"}));
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[0], std::string("x,y,z,") + kAnswers);
  EXPECT_EQ(rows[1].rfind("0,0,30,true,", 0), 0U) << rows[1];
  EXPECT_NE(rows[1].find(",,false,false,"), std::string::npos) << rows[1];
  EXPECT_EQ(rows[2].rfind("60,0,5,false,-", 0), 0U) << rows[2];
  EXPECT_NE(rows[2].find(",block,true,"), std::string::npos) << rows[2];
  EXPECT_NE(rows[2].find(",true,false,"), std::string::npos) << rows[2];
  EXPECT_EQ(rows[3].rfind("0,0,80,false,-", 0), 0U) << rows[3];
  EXPECT_NE(rows[3].find(",,true,false,"), std::string::npos) << rows[3];
  EXPECT_NE(rows[4].find(",true,"), std::string::npos) << rows[4];
}

// Names come from maps of others: none may become a formula, and each must be told from the next.
TEST_F(CliQuery, NamesInTablesAreTextAndApart) {
  std::string city = kCity;
  city.replace(city.find("o block"), 7, "o =1;x\\");
  write("city.obj", city + "o +2\nv 20 -5 20\nv 30 -5 20\nv 30 5 20\nf 13 14 15\n");
  write("mission.yaml", std::string(kScene) +
                            "targets: [{name: '@t', vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]}, "
                            "{name: \"a,b\", vertices: [[-9, -5, 0], [-7, -5, 0], [-7, 5, 0], [-9, 5, 0]]}]\n"
                            "combine: each\n" +
                            kSensor);
  write("points.csv", "x,y,z,note\n40,0,5,=mine\n45,-2,30,-5\n");
  output_of({"query", "mission.yaml", "points.csv", "--target", "@t", "-o", "out.csv"});
  const std::vector<std::string> rows = lines(content(folder_ / "out.csv"));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].rfind("40,0,5,=mine,false,", 0), 0U) << rows[1];
  EXPECT_NE(rows[1].find(",'=1\\;x\\\\,"), std::string::npos) << rows[1];
  EXPECT_NE(rows[2].find(",'+2;=1\\;x\\\\,"), std::string::npos) << rows[2];
  write("again.csv", content(folder_ / "out.csv"));
  const ProgramRun again = run({"query", "mission.yaml", "again.csv", "--target", "@t"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, content(folder_ / "out.csv"));
}

TEST_F(CliQuery, NamesBrokenLimits) {
  write("mission.yaml", std::string(kScene) + kTarget + kSensor + "navigation: {altitude: [10, 20]}\n");
  options_.input = "0 0 15\n0 0 5\n0 0 25\n";
  const std::vector<std::string> rows = lines(output_of({"query", "mission.yaml", "-"}));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_NE(rows[1].find("true"), std::string::npos) << rows[1];
  EXPECT_NE(rows[2].find("altitude min"), std::string::npos) << rows[2];
  EXPECT_NE(rows[3].find("altitude max"), std::string::npos) << rows[3];
}

TEST_F(CliQuery, TakesAnyTable) {
  const std::string expected = output_of({"query", "mission.yaml", "-"});
  EXPECT_EQ(lines(expected).size(), 1U) << "no points, only the header";
  options_.input = "1,2,30\n";
  const std::string answers = output_of({"query", "mission.yaml", "-"});
  for (const char* text : {"1 2 30\n", "1\t2\t30", "1;2;30\r\n", " 1 , 2 , 30\n", "x,y,z\n1,2,30\n", "X;Y;Z\n1;2;30\n",
                           "\xEF\xBB\xBF\"x\",\"y\",\"z\"\n\"1\",\"2\",\"30\"\n", "# note\n\n  \n1,2,30",
                           "x y z\n1 2 30\n", "1.0,2e0,+30"}) {
    options_.input = text;
    EXPECT_EQ(output_of({"query", "mission.yaml", "-"}), answers) << text;
  }
}

// `check` reads the same titles.
TEST_F(CliQuery, TakesTheTitlesOfPlans) {
  options_.input = "1,2,30.48\n";
  const std::string answer =
      lines(output_of({"query", "mission.yaml", "-"})).at(1).substr(std::string("1,2,30.48").size());
  const auto expect_same = [&](const std::string& text, const std::string& begin) {
    SCOPED_TRACE(text);
    options_.input = text;
    const std::vector<std::string> rows = lines(output_of({"query", "mission.yaml", "-"}));
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[1], begin + answer);
  };
  expect_same("x_m,y (m),Z (ft)\n1,2,100\n", "1,2,100");
  expect_same("X;Y;Z\n1;2;30,48\n", "1,2,30.48");
  expect_same("\xEF\xBB\xBFx;y;z\n1,0;2,0;30,48\n", "1,2,30.48");
  const auto expect_bad_points = [&](const std::string& text, const std::string& line) {
    write("points.csv", text);
    expect_bad({"query", "mission.yaml", "points.csv", "-o", "volume.ply"}, "points.csv" + line);
  };
  expect_bad_points("x,y,height\n1,2,3\n", ":1");
  expect_bad_points("x,y,height_home_m\n1,2,3\n", "");
  expect_bad_points("x,y,hae\n1,2,3\n", "");
  expect_bad_points("x,y,AltitudeAMSL,AltitudeAGL\n1,2,3,4\n", ":1");
  options_.input = "x,y,height,z\n1,2,7,30.48\n";
  EXPECT_EQ(lines(output_of({"query", "mission.yaml", "-", "-q"})).at(1), "1,2,7,30.48" + answer);
  expect_bad_points("x;y;z\n1,5;2.5;3\n", ":2");
  expect_bad_points("lat,lon,z\n47\u00b061'0\"N,11,3\n", ":2");
  write("mission.yaml", std::string(kScene) + kTarget + kSensor + "tour: {home: [0, 0, 5]}\n");
  expect_same("x,y,height above home (m)\n1,2,25.48\n", "1,2,25.48");
  write("mission.yaml",
        "scene: {mesh: city.obj, origin: [48.1, 11.5], sea_level: -500}\n" + std::string(kTarget) + kSensor);
  options_.input = "Latitude,LNG,z\n48.1,11.5,30.48\n";
  const std::string placed = lines(output_of({"query", "mission.yaml", "-", "-q"})).at(1);
  options_.input = "Latitude,LNG,z\n\"48\u00b0 6' 0\"\"N\",11\u00b029'60\"E,30.48\n";
  EXPECT_EQ(lines(output_of({"query", "mission.yaml", "-", "-q"})).at(1), placed);
  const std::string above_sea = "48.1,11.5,530.48" + placed.substr(std::string("48.1,11.5,30.48").size());
  for (const std::string title : {"amsl", "Altitude AMSL (m)", "AltitudeAMSL", "msl"}) {
    options_.input = "latitude,longitude," + title + "\n48.1,11.5,530.48\n";
    EXPECT_EQ(lines(output_of({"query", "mission.yaml", "-", "-q"})).at(1), above_sea) << title;
  }
  // The titles of check that do not say what they are measured from.
  for (const std::string title : {"alt", "altitude(m)", "elevation_m", "ele", "height"}) {
    options_.input = "latitude,longitude," + title + "\n48.1,11.5,530.48\n";
    const std::string row = lines(output_of({"query", "mission.yaml", "-", "-q", "--heights", "sea"})).at(1);
    EXPECT_EQ(row, above_sea) << title;
    write("points.csv", options_.input);
    expect_bad({"query", "mission.yaml", "points.csv", "-q"}, "points.csv:1");
  }
}

TEST_F(CliQuery, WritesAFile) {
  write("points.csv", "0,0,30\n");
  const std::string answers = output_of({"query", "mission.yaml", "points.csv"});
  EXPECT_EQ(output_of({"query", "mission.yaml", "points.csv", "-o", "answers.csv"}), "");
  EXPECT_EQ(content(folder_ / "answers.csv"), answers);
}

TEST_F(CliQuery, RefusesBadRows) {
  const auto expect_bad_points = [&](const std::string& text, const std::string& line) {
    write("points.csv", text);
    expect_bad({"query", "mission.yaml", "points.csv", "-o", "volume.ply"}, "points.csv:" + line);
  };
  expect_bad_points("1,2,3\n4,5\n", "2");
  expect_bad_points("1,2,3\n\n4,five,6\n", "3");
  expect_bad_points("x,y,z\n1,2,\n", "2");
  expect_bad_points("1,2,nan\n", "1");
  expect_bad_points("1,2,-inf\n", "1");
  expect_bad_points("1,2,1e999\n", "1");
  expect_bad_points("1;2,5;3.5\n", "1");
  expect_bad_points("a,b,c\n1,2,3\n", "1");
  expect_bad_points("x,y\n1,2\n", "1");
  expect_bad({"query", "mission.yaml", "none.csv"}, "none.csv");
  expect_bad({"query", "mission.yaml", "."}, ".");
}

TEST_F(CliQuery, KeepsAllColumnsInTheirOrder) {
  const auto rows_of = [&](const std::string& text) {
    options_.input = text;
    return lines(output_of({"query", "mission.yaml", "-"}));
  };
  auto rows = rows_of("id;note;Z;X;Y;\n007;\"tall; \"\"old\"\" tree\";30;1;2.50;\nb;a,b;31;0;0;x\n\n;;32;0;0\n");
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0], std::string("id,note,z,x,y,,") + kAnswers);
  EXPECT_EQ(rows[1].rfind("007,\"tall; \"\"old\"\" tree\",30,1,2.5,,true,", 0), 0U) << rows[1];
  EXPECT_EQ(rows[2].rfind("b,\"a,b\",31,0,0,x,true,", 0), 0U) << rows[2];
  EXPECT_EQ(rows[3].rfind(",,32,0,0,,true,", 0), 0U) << rows[3];

  rows = rows_of("1 2 30 oak \"two words\"\n1 2 31 elm\n");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0], std::string("x,y,z,column_4,column_5,") + kAnswers);
  EXPECT_EQ(rows[1].rfind("1,2,30,oak,\"two words\",true,", 0), 0U) << rows[1];
  EXPECT_EQ(rows[2].rfind("1,2,31,elm,,true,", 0), 0U) << rows[2];

  rows = rows_of("x\ty\tz\ta\tb\n1\t2\t30\t\tlast\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1].rfind("1,2,30,,last,true,", 0), 0U) << rows[1];
}

TEST_F(CliQuery, KeepsLineBreaksInQuotes) {
  options_.input = "x,y,z,note\r\n0,0,30,\"first\nsecond, third\"\r\n0,0,five,\"\"\r\n";
  const ProgramRun refused = run({"query", "mission.yaml", "-"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("standard input:4"), std::string::npos) << refused.err;
  options_.input = "x,y,z,note\r\n0,0,30,\"first\nsecond, third\"\r\n0,0,31,\"\"\r\n";
  const std::string answers = output_of({"query", "mission.yaml", "-"});
  EXPECT_NE(answers.find("\n0,0,30,\"first\nsecond, third\",true,"), std::string::npos) << answers;
  EXPECT_NE(answers.find("\n0,0,31,\"\",true,"), std::string::npos) << answers;
}

TEST_F(CliQuery, AnswersReplaceThoseOfAnEarlierRun) {
  options_.input = "id,x,y,z\na,0,0,30\nb,60,0,5\n";
  const std::string answers = output_of({"query", "mission.yaml", "-"});
  options_.input = answers;
  const ProgramRun again = run({"query", "mission.yaml", "-"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, answers);
  EXPECT_NE(again.err.find("margin_m"), std::string::npos) << again.err;
}

TEST_F(CliQuery, RefusesTablesThatAreNoTables) {
  const auto expect_bad_points = [&](const std::string& text, const std::string& line) {
    write("points.csv", text);
    expect_bad({"query", "mission.yaml", "points.csv", "-o", "volume.ply"}, "points.csv:" + line);
  };
  expect_bad_points("x,y,z\n1,2,3\n1,2,3,4\n", "3");
  expect_bad_points("1 2 3 oak\n1 2 3 old oak\n", "2");
  expect_bad_points("1,2,3,a\n1,2,3,\"b\n1,2,3,c\n", "2");
  expect_bad_points("1,2,3,\"" + std::string(2 << 20, 'a') + "\"\n", "1");
  expect_bad_points("1,2,3\n" + std::string(3 << 20, '1'), "2");
  expect_bad_points("1,2,3,\"" + std::string(2 << 20, '\n'), "1");
  write("points.csv", "x,y,z,a,a\n0,0,30,1,2\n");
  expect_bad({"query", "mission.yaml", "points.csv", "--json"}, "points.csv:1");
}

TEST_F(CliQuery, WritesJson) {
  write("points.csv", "id,x,y,z,note\n07,0,0,30,\"say \"\"hi\"\"\"\n8,60,0,5,\xff\n9,0,0,-1e155,\n");
  const auto json = nlohmann::json::parse(output_of({"query", "mission.yaml", "points.csv", "--json"}));
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[0].at("id"), "07");
  EXPECT_EQ(json[0].at("note"), "say \"hi\"");
  EXPECT_EQ(json[0].at("z"), 30);
  EXPECT_EQ(json[0].at("inside"), true);
  EXPECT_NEAR(json[0].at("margin_m").get<double>(), std::sqrt(60. * 60 - 50) - 30, 1e-12);
  EXPECT_EQ(json[1].at("blocked_by"), nlohmann::json({"block"}));
  EXPECT_EQ(json[1].at("out_of_range"), true);
  EXPECT_EQ(json[2].at("behind_target"), true);
  EXPECT_EQ(json[2].at("outside_of"), nlohmann::json::array());
  EXPECT_NEAR(json[2].at("margin_m").get<double>() / -1e155, 1, 1e-12);
  EXPECT_EQ(nlohmann::json::parse(output_of({"query", "mission.yaml", "-", "--json"})).size(), 0U);
  write("mission.yaml", std::string(kScene) + kTarget + kSensor + "navigation: {altitude: [10, 20]}\n");
  options_.input = "50 0 0.5\n";
  const auto nowhere = nlohmann::json::parse(output_of({"query", "mission.yaml", "-", "--json"}));
  EXPECT_TRUE(nowhere[0].at("margin_m").is_null());
  EXPECT_EQ(nowhere[0].at("outside_of"), nlohmann::json({"altitude min"}));
}

TEST_F(CliQuery, OneHeightForAll) {
  options_.input = "1 2 30\n3 4 30\n";
  const auto with = lines(output_of({"query", "mission.yaml", "-"}));
  options_.input = "1 2\n3 4\n";
  const auto without = lines(output_of({"query", "mission.yaml", "-", "--z", "30"}));
  ASSERT_EQ(without.size(), 3U);
  EXPECT_EQ(without[0], std::string("x,y,") + kAnswers);
  for (std::size_t i = 1; i < 3; ++i) EXPECT_EQ(without[i].substr(4), with[i].substr(7));
  write("points.csv", "x,y,z\n1,2,3\n");
  expect_bad({"query", "mission.yaml", "points.csv", "--z", "30"}, "points.csv:1");
  expect_bad({"query", "mission.yaml", "points.csv", "--z", "high"}, "--z");
}

TEST_F(CliQuery, AddsHowMuchIsSeen) {
  write("points.csv", "x,y,z\n0,0,30\n40,0,24\n60,0,5\n0,0,-3\n");
  const auto fractions = [&](const std::string& measure) {
    std::vector<double> values;
    const auto rows = lines(output_of({"query", "mission.yaml", "points.csv", "--fraction", measure}));
    EXPECT_EQ(rows.at(0), std::string("x,y,z,") + kAnswers + ",fraction");
    const auto plain = lines(output_of({"query", "mission.yaml", "points.csv"}));
    for (std::size_t i = 1; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i].rfind(plain.at(i) + ",", 0), 0U) << rows[i];
      values.push_back(std::stod(rows[i].substr(plain[i].size() + 1)));
    }
    const auto json =
        nlohmann::json::parse(output_of({"query", "mission.yaml", "points.csv", "--fraction", measure, "--json"}));
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(json[i].at("fraction"), values[i]);
    return values;
  };
  const auto area = fractions("area"), angle = fractions("solid_angle"), pixels = fractions("pixels");
  for (const auto& values : {area, angle, pixels}) {
    ASSERT_EQ(values.size(), 4U);
    EXPECT_EQ(values[0], 1);
    EXPECT_EQ(values[2], 0);
    EXPECT_EQ(values[3], 0);
  }
  // The roof's edge at x = 20, 12 m high, is half-way between the eye and x = 0. The hidden half is the nearer one.
  EXPECT_NEAR(area[1], 0.5, 1e-14);
  EXPECT_LT(angle[1], 0.49);
  EXPECT_GT(angle[1], 0.3);
  EXPECT_LT(pixels[1], 0.49);
  EXPECT_NE(angle[1], pixels[1]);
  expect_bad({"query", "mission.yaml", "points.csv", "--fraction", "volume"});
}

TEST_F(CliQuery, AFractionReplacesThatOfAnEarlierRun) {
  options_.input = "fraction,x,y,z\n2/3,0,0,30\n";
  EXPECT_EQ(lines(output_of({"query", "mission.yaml", "-"})).at(1).rfind("2/3,0,0,30,true,", 0), 0U) << "kept";
  const ProgramRun again = run({"query", "mission.yaml", "-", "--fraction", "area"});
  EXPECT_EQ(lines(again.out).at(0), std::string("x,y,z,") + kAnswers + ",fraction");
  EXPECT_EQ(lines(again.out).at(1).substr(lines(again.out).at(1).size() - 2), ",1");
  EXPECT_NE(again.err.find("fraction"), std::string::npos) << again.err;
}

TEST_F(CliQuery, WritesSeenParts) {
  write("points.csv", "ID,x,y,z\nhigh,0,0,30\nbehind the block,40,0,24\nbelow,0,0,-3\n");
  const std::vector<std::string> plain = {"query", "mission.yaml", "points.csv", "--fraction", "area"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), plain.begin(), plain.end());
    return more;
  };
  const std::string answers = output_of(plain);
  const ProgramRun written = run(with({"--seen", "seen.geojson"}));
  EXPECT_EQ(written.exit_code, 0);
  EXPECT_EQ(written.out, answers);
  testing::expect_wording(written.err);
  EXPECT_EQ(run(with({"--seen", "seen.geojson", "--quiet"})).err, "");
  const std::string text = content(folder_ / "seen.geojson");
  const auto json = nlohmann::json::parse(text);
  ASSERT_EQ(json.at("features").size(), 3U);
  EXPECT_EQ(json["features"][0]["id"], "high");
  EXPECT_EQ(json["features"][0]["geometry"]["coordinates"][0].size(), 5U) << "the whole square";
  EXPECT_EQ(json["features"][1]["id"], "behind the block");
  EXPECT_NEAR(json["features"][1]["properties"]["fraction"].get<double>(), 0.5, 1e-14);
  EXPECT_EQ(json["features"][1]["geometry"]["coordinates"][0].size(), 5U) << "half of it";
  EXPECT_TRUE(json["features"][2]["geometry"].is_null());
  EXPECT_EQ(run(with({"--seen", "-", "-o", "answers.csv"})).out, text);
  EXPECT_EQ(content(folder_ / "answers.csv"), answers);

  fs::remove(folder_ / "answers.csv");
  expect_bad({"query", "mission.yaml", "points.csv", "--seen", "seen.geojson"}, "--seen");
  expect_bad(with({"--seen", "-"}), "--seen");
  expect_bad(with({"--seen", "a.csv", "-o", "a.csv"}), "a.csv");
  expect_bad(with({"--seen", "points.csv"}), "points.csv");
  expect_bad(with({"--seen", "city.obj"}), "city.obj");
  expect_bad(with({"--seen", "none/seen.geojson"}), "none");
  write("bad.csv", "0,0,30\n0,0,high\n");
  expect_refused({"query", "mission.yaml", "bad.csv", "--fraction", "area", "--seen", "seen.geojson"}, "bad.csv:2");
  EXPECT_EQ(content(folder_ / "seen.geojson"), text) << "as it was";
  write("mission.yaml", std::string(kScene) + "target: {point: [0, 0, 1]}\n" + kSensor);
  expect_bad(with({"--seen", "seen.geojson"}), "--seen");
}

/// City on the earth: its x and y are metres east and north of the origin.
constexpr const char* kPlacedScene = "scene: {mesh: city.obj, origin: [48.1, 11.5]}\n";

TEST_F(CliQuery, WritesSeenPartsInDegrees) {
  write("mission.yaml", std::string(kPlacedScene) + kTarget + kSensor);
  options_.input = "0 0 30\n";
  output_of({"query", "mission.yaml", "-", "--fraction", "area", "--seen", "seen.geojson"});
  const auto json = nlohmann::json::parse(content(folder_ / "seen.geojson"));
  const auto& ring = json.at("features")[0]["geometry"]["coordinates"][0];
  ASSERT_EQ(ring.size(), 5U);
  for (const auto& position : ring) {
    const Eigen::Vector2d xy = scene_position({48.1, 11.5, "", ""}, position[0], position[1]);
    EXPECT_NEAR(xy.cwiseAbs().minCoeff(), 5, 1e-7);
    EXPECT_NEAR(xy.cwiseAbs().maxCoeff(), 5, 1e-7);
  }
}

TEST_F(CliQuery, TakesLongitudeAndLatitude) {
  write("mission.yaml", std::string(kPlacedScene) + kTarget + kSensor);
  const Georeference place{48.1, 11.5, "", ""};
  std::ostringstream degrees, metres;
  degrees.precision(17);
  metres.precision(17);
  degrees << "height,LAT,Longitude,z\n";
  for (const double lon : {11.4993, 11.5, 11.50031, 11.6}) {
    for (const double lat : {48.0996, 48.1, 48.10037}) {
      const Eigen::Vector2d xy = scene_position(place, lon, lat);
      degrees << "h," << lat << ',' << lon << ",5\n";
      metres << xy.x() << ',' << xy.y() << ",5\n";
    }
  }
  options_.input = metres.str();
  const auto expected = lines(output_of({"query", "mission.yaml", "-"}));
  write("degrees.csv", degrees.str());
  const auto answers = lines(output_of({"query", "mission.yaml", "degrees.csv", "-q"}));
  ASSERT_EQ(answers.size(), 13U);
  ASSERT_EQ(expected.size(), 13U);
  EXPECT_EQ(answers[0], std::string("height,LAT,Longitude,z,") + kAnswers);
  const auto answer = [](const std::string& row) { return row.substr(row.find(",5,") + 3); };
  int inside = 0;
  for (std::size_t i = 1; i < answers.size(); ++i) {
    EXPECT_EQ(answer(answers[i]), answer(expected[i])) << answers[i];
    inside += answer(answers[i]).starts_with("true");
  }
  EXPECT_GT(inside, 0);
  EXPECT_EQ(answers[5].rfind("h,48.1,11.5,5,true,", 0), 0U) << answers[5];

  options_.input = "11.5 48.1 5\n";
  EXPECT_NE(output_of({"query", "mission.yaml", "-", "-q", "--lonlat"}).find("\n11.5,48.1,5,true,"), std::string::npos);
  testing::expect_wording(run({"query", "mission.yaml", "-", "--lonlat"}).err);
  options_.input = "lon,lat,x,y,z\n11.5,48.1,0,70,5\n";
  EXPECT_NE(output_of({"query", "mission.yaml", "-", "-q"}).find("11.5,48.1,0,70,5,false,"), std::string::npos);
  EXPECT_NE(output_of({"query", "mission.yaml", "-", "-q", "--lonlat"}).find("11.5,48.1,0,70,5,true,"),
            std::string::npos);
}

/// A valley of a map: the ground rises by 20 m from west to east.
void write_hill(const std::filesystem::path& file) {
  std::ofstream stream(file);
  stream << "o ground\nv -100 -100 500\nv 100 -100 520\nv 100 100 520\nv -100 100 500\nf 1 2 3 4\n";
}

TEST_F(CliQuery, HeightsMayBeAboveTheSeaOrTheGround) {
  write_hill(folder_ / "hill.obj");
  const std::string target = "target: {point: [0, 0, 515]}\n";
  write("hill.yaml", "scene: {mesh: hill.obj, sea_level: 20}\n" + target + kSensor);
  const auto inside = [&](const std::string& header, const std::string& row) {
    options_.input = header + "\n" + row + "\n";
    const std::vector<std::string> answers = lines(output_of({"query", "hill.yaml", "-", "-q"}));
    return answers.size() == 2 ? answers[1] : "";
  };
  const auto rest = [](const std::string& row) { return row.substr(row.find(",true")); };
  // At x = 50 the ground is at z 515; the sea is at z 20.
  const std::string expected = inside("x,y,z", "50,0,525");
  EXPECT_EQ(expected.rfind("50,0,525,true,", 0), 0U) << expected;
  for (const auto& [header, row] :
       {std::pair("x,y,amsl", "50,0,505"), {"MSL,y,X", "505,0,50"}, {"x,y,agl", "50,0,10"}}) {
    const std::string answer = inside(header, row);
    EXPECT_EQ(answer.rfind(row, 0), 0U) << answer;  // as it was given
    EXPECT_EQ(rest(answer), rest(expected)) << header;
  }
  EXPECT_NE(inside("x,y,agl", "50,0,-1").find("ground"), std::string::npos);  // below it
  for (const auto& [level, row] : {std::pair("sea", "50,0,505"), {"ground", "50,0,10"}, {"scene", "50,0,525"}}) {
    for (const std::string header : {"", "x,y,height\n"}) {
      options_.input = header + row + "\n";
      const std::vector<std::string> answers = lines(output_of({"query", "hill.yaml", "-", "-q", "--heights", level}));
      ASSERT_EQ(answers.size(), 2U);
      EXPECT_EQ(answers[0].rfind("x,y,height,inside", 0), 0U) << answers[0];
      EXPECT_EQ(rest(answers[1]), rest(expected)) << level << header;
    }
    options_.input = std::string("x,y,height,z,agl\n") + "50,0,-1,525,-1\n";  // z says it
    EXPECT_EQ(rest(lines(output_of({"query", "hill.yaml", "-", "-q", "--heights", level})).at(1)), rest(expected));
  }
  expect_bad({"query", "hill.yaml", "-", "--heights", "sea", "--z", "5"}, "command line");
  options_.input = "x,y,z,alt\n50,0,525,3\n";
  testing::expect_wording(run({"query", "hill.yaml", "-"}).err);
  const auto refused = [&](const std::string& points, const std::string& mission, const std::string& where) {
    write("points.csv", points);
    expect_bad({"query", mission, "points.csv", "-q"}, where);
  };
  refused("x,y,amsl,agl\n50,0,505,10\n", "hill.yaml", "points.csv:1");
  refused("x,y,agl\n50,0,10\n500,0,10\n", "hill.yaml", "points.csv:3");  // beyond the ground
  write("points.csv", "x,y,amsl\n50,0,505\n");
  expect_bad({"query", "hill.yaml", "points.csv", "-q", "--z", "5"}, "points.csv:1");
  write("nowhere.yaml", "scene: {mesh: hill.obj}\n" + target + kSensor);
  refused("x,y,amsl\n50,0,505\n", "nowhere.yaml", "points.csv");
  write("bare.obj", "o roof\nv 0 0 500\nv 9 0 500\nv 9 9 500\nf 1 2 3\n");
  write("bare.yaml", "scene: {mesh: bare.obj}\n" + target + kSensor);
  refused("x,y,agl\n50,0,10\n", "bare.yaml", "points.csv");
}

/// Which one is meant, nobody knows. Of a column that is not used, nothing is asked.
TEST_F(CliQuery, OfOneMeaningThereIsOneColumn) {
  write_hill(folder_ / "hill.obj");
  write("hill.yaml", "scene: {mesh: hill.obj, sea_level: 20}\ntarget: {point: [0, 0, 515]}\n" + std::string(kSensor));
  for (const char* const header : {"x,y,amsl,alt_msl", "Altitude AMSL,MSL,x,y", "x,y,agl,agl", "x,X,y,z",
                                   "lon,lat,longitude,z", "lat,lon,z,latitude", "x,y,z,z"}) {
    write("points.csv", std::string(header) + "\n50,0,505,10\n");
    expect_bad({"query", "hill.yaml", "points.csv", "-q"}, "points.csv:1");
  }
  options_.input = "x,y,z,lon,longitude,alt,altitude\n50,0,525,1,2,3,4\n";
  const ProgramRun taken = run({"query", "hill.yaml", "-"});
  EXPECT_EQ(taken.exit_code, 0) << taken.err;
  EXPECT_NE(taken.err.find("z and alt:"), std::string::npos) << taken.err;
  EXPECT_NE(taken.err.find("z and altitude:"), std::string::npos) << taken.err;
}

TEST_F(CliQuery, OneHeightMayHaveAUnit) {
  options_.input = "0 0\n";
  const std::string metres = output_of({"query", "mission.yaml", "-", "--z", "30.48"});
  EXPECT_EQ(output_of({"query", "mission.yaml", "-", "--z", "100 ft"}), metres);
  write("points.csv", "0 0\n");
  expect_bad({"query", "mission.yaml", "points.csv", "--z", "100 yd"}, "--z");
  write("feet.csv", "x,y,z\n0,0,60 ft\n");
  expect_bad({"query", "mission.yaml", "feet.csv"}, "feet.csv:2");
}

TEST_F(CliQuery, SaysThatLongitudeAndLatitudeSeemSwapped) {
  // Where both are much the same, swapped ones are near enough to be answered.
  write("mission.yaml", "scene: {mesh: city.obj, origin: [48.2, 48.21]}\n" + std::string(kTarget) + kSensor);
  options_.input = "lon,lat,z\n48.2,48.21,5\n48.21,48.2,5\n48.21,48.20005,5\n";
  const ProgramRun answered = run({"query", "mission.yaml", "-"});
  EXPECT_EQ(answered.exit_code, 0);
  EXPECT_NE(answered.err.find(" 1 of the points"), std::string::npos) << answered.err;
  testing::expect_wording(lines(answered.err).back());
  EXPECT_EQ(run({"query", "mission.yaml", "-", "-q"}).err, "");
  options_.input = "lon,lat,z\n48.21,48.2,5\n";
  EXPECT_EQ(run({"query", "mission.yaml", "-"}).err.find("1 of the points"), std::string::npos);
}

TEST_F(CliQuery, RefusesPlacesThatAreNone) {
  const auto expect_bad_points = [&](const std::string& row) {
    write("points.csv", "lon,lat,z\n11.5,48.1,9\n\n" + row + "\n");
    expect_bad({"query", "mission.yaml", "points.csv", "-q", "-o", "volume.ply"}, "points.csv:4");
  };
  write("points.csv", "lon,lat,z\n11.5,48.1,9\n");
  expect_bad({"query", "mission.yaml", "points.csv", "-q"}, "points.csv:2");
  write("mission.yaml", std::string(kPlacedScene) + kTarget + kSensor);
  expect_bad_points("11.5,91,9");
  expect_bad_points("181,48.1,9");
  expect_bad_points("48.1,11.5,9");
  expect_bad_points("0,0,9");
  expect_bad_points("11.5,nan,9");
  expect_bad_points("11.5,,9");
  write("points.csv", "lon,lat\n11.5,48.1\n");
  expect_bad({"query", "mission.yaml", "points.csv"}, "points.csv:1");
  write("points.csv", "lon,x,z\n11.5,48.1,3\n");
  expect_bad({"query", "mission.yaml", "points.csv", "--lonlat"}, "points.csv:1");
}

/// A command of bash, in the test's folder; $V is the program.
ProgramRun shell(const RunOptions& options, const std::string& command) {
  return run_program("/bin/bash", {"-c", "V='" + program_file().string() + "'; " + command}, options);
}

TEST_F(CliQuery, EndsQuietlyWhenNoOneReads) {
  std::string points;
  for (int i = 0; i < 200000; ++i) points += "0,0," + std::to_string(i % 50 + 1) + "\n";
  write("points.csv", points);
  for (const std::string json : {"", " --json"}) {
    const ProgramRun result =
        shell(options_, "$V query mission.yaml points.csv" + json + " | head -n 2 > first.txt; echo ${PIPESTATUS[0]}");
    EXPECT_EQ(result.out, "141\n");
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(lines(content(folder_ / "first.txt")).size(), 2U);
  }
}

TEST_F(CliQuery, AnswersAsPointsCome) {
  options_.timeout_s = 100;
  const ProgramRun result = shell(options_,
                                  "{ echo x,y,z; sleep 0.2; echo 0,0,30; for i in $(seq 800); do"
                                  " grep -q true answers.csv && break; sleep 0.1; done;"
                                  " cp answers.csv seen.csv; echo 0,0,31; } | $V query mission.yaml - > answers.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(lines(content(folder_ / "seen.csv")).size(), 2U);
  EXPECT_EQ(lines(content(folder_ / "answers.csv")).size(), 3U);
}

TEST_F(CliQuery, AMistakeFarDownLeavesNoFile) {
  std::string points = "x,y,z\n";
  for (int i = 0; i < 300000; ++i) points += "0,0,30\n";
  write("points.csv", points + "0,0,here\n");
  expect_bad({"query", "mission.yaml", "points.csv", "-o", "volume.ply"}, "points.csv:300002");
  const ProgramRun printed = run({"query", "mission.yaml", "points.csv"});
  EXPECT_EQ(printed.exit_code, 2);
  EXPECT_GT(lines(printed.out).size(), 100000U) << "what came before the portion with the mistake";
  write("points.csv", points);
  EXPECT_EQ(lines(output_of({"query", "mission.yaml", "points.csv", "--threads", "2"})).size(), 300001U);
}

TEST_F(CliQuery, EndsOnCtrlCWhileItWaits) {
  options_.signal = SIGINT;
  options_.signal_when = [&](const std::string&) { return !content(folder_ / "answers.csv").empty(); };
  const core::Stopwatch stopwatch;
  const ProgramRun result = shell(options_, "exec $V query mission.yaml - < <(echo 0,0,30; sleep 60) > answers.csv");
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_LT(stopwatch.seconds(), 30);
}

}  // namespace
}  // namespace vantage::testing
