// `vantage devices`: what can render here.
#include "support/cli_fixture.h"
#include "vantage/devices.h"

namespace vantage::testing {
namespace {

using CliDevices = Cli;

TEST_F(CliDevices, ShowsWhatIsThereAndWhatWouldBeUsed) {
  const RenderDevices found = render_devices();
  const std::string table = output_of({"devices"});
  for (const RenderDevice& device : found.devices) {
    EXPECT_NE(table.find("device " + std::to_string(device.index) + ": " + device.name), std::string::npos) << table;
  }
  EXPECT_NE(table.find("be used"), std::string::npos) << table;
  EXPECT_NE(table.find(found.why_no_opengl), std::string::npos) << table;

  const auto json = nlohmann::json::parse(output_of({"devices", "--json"}));
  ASSERT_EQ(json.at("devices").size(), found.devices.size());
  EXPECT_EQ(json.at("devices").at(0).at("kind"), "cpu");
  const int largest = json.at("devices").at(0).at("largest_face_size");
  EXPECT_EQ(largest, found.devices[0].largest_face_size);
  const std::string why = json.at("why_no_opengl");
  EXPECT_EQ(why, found.why_no_opengl);
  const std::string used = json.at("devices").at(json.at("used").get<std::size_t>()).at("kind");
  EXPECT_NE(used, "opengl_software") << "slower than the CPU, on which it runs";
  EXPECT_FALSE(json.at("why").get<std::string>().empty());
}

TEST_F(CliDevices, TellsWhatAChoiceMeans) {
  EXPECT_EQ(nlohmann::json::parse(output_of({"devices", "--json", "--device", "cpu"})).at("used"), 0);
  EXPECT_EQ(nlohmann::json::parse(output_of({"devices", "--json", "--device", "0"})).at("used"), 0);
  expect_refused({"devices", "--device", "99"}, "0: CPU");  // the words have this machine's devices in them
  expect_bad({"devices", "--device", "fast"}, "--device");
  for (const RenderDevice& device : render_devices().devices) {
    if (device.kind == DeviceKind::opengl_hardware) return;
  }
  expect_refused({"devices", "--device", "gpu"}, "0: CPU");
}

}  // namespace
}  // namespace vantage::testing
