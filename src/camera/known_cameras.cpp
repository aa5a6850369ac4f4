// The table of cameras. A number is here only if a document of the maker or a picture's metadata has it, read or as
// others quote it; "by" names a list that does: docs/camera.md. Names: maker, model, and the lens where it can be
// chosen.
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/camera.h"
#include "vantage/error.h"
#include "vantage/input.h"

namespace vantage {
namespace {

struct CameraRow {
  const char *name, *maker, *model;
  int width_px, height_px;
  double sensor_width_mm, sensor_height_mm, focal_length_mm;
  const char* source;
};

constexpr const char* kP1 = "DJI, Zenmuse P1 specifications: sensor 35.9 x 24 mm; the lens by its name";
constexpr const char* kPhantom = "DJI, Phantom 4 specifications: 8.8 mm; sensor of type 1: 13.2 x 8.8 mm";
constexpr const char* kAltum = "MicaSense, metadata of its pictures: pixels of 3.45 um, 8 mm";
constexpr const char* kIxm = "Phase One, iXM-100 specifications: sensor 43.9 x 32.9 mm; the lens by its name";

constexpr std::array kCameraRows = {
    CameraRow{"canon_eos_m_22mm", "Canon", "EOS M, lens of 22 mm", 5184, 3456, 22.3, 14.9, 22,
              "Canon, EOS M specifications, by QGroundControl's list"},
    CameraRow{"canon_g9_x", "Canon", "PowerShot G9 X, widest", 5488, 3680, 13.2, 8.8, 10.2,
              "Canon, PowerShot G9 X specifications, by QGroundControl's list"},
    CameraRow{"canon_sx260_hs", "Canon", "PowerShot SX260 HS, widest", 4000, 3000, 6.17, 4.55, 4.5,
              "Canon, PowerShot SX260 HS specifications, by QGroundControl's list"},
    CameraRow{"dji_mavic_2_pro", "DJI", "Mavic 2 Pro (Hasselblad L1D-20c)", 5472, 3648, 13.2, 8.8, 10.26,
              "DJI, metadata of its pictures: 10.26 mm; sensor of type 1: 13.2 x 8.8 mm"},
    CameraRow{"dji_mavic_3e_wide", "DJI", "Mavic 3E, wide camera", 5280, 3956, 17.3, 13.0, 12.29,
              "DJI, metadata of its pictures: 12.29 mm; sensor of type 4/3: 17.3 x 13 mm"},
    CameraRow{"dji_phantom_4_pro", "DJI", "Phantom 4 Pro", 5472, 3648, 13.2, 8.8, 8.8, kPhantom},
    CameraRow{"dji_phantom_4_rtk", "DJI", "Phantom 4 RTK", 5472, 3648, 13.2, 8.8, 8.8, kPhantom},
    CameraRow{"dji_zenmuse_h20t_thermal", "DJI", "Zenmuse H20T, thermal camera", 640, 512, 7.68, 6.144, 13.5,
              "DJI, Zenmuse H20T specifications: pixels of 12 um, 13.5 mm, width by OpenSfM's list"},
    CameraRow{"dji_zenmuse_p1_24mm", "DJI", "Zenmuse P1, lens of 24 mm", 8192, 5460, 35.9, 24, 24, kP1},
    CameraRow{"dji_zenmuse_p1_35mm", "DJI", "Zenmuse P1, lens of 35 mm", 8192, 5460, 35.9, 24, 35, kP1},
    CameraRow{"dji_zenmuse_p1_50mm", "DJI", "Zenmuse P1, lens of 50 mm", 8192, 5460, 35.9, 24, 50, kP1},
    CameraRow{"dji_zenmuse_x7_24mm", "DJI", "Zenmuse X7, lens of 24 mm", 6016, 4008, 23.5, 15.7, 24,
              "DJI, Zenmuse X7 specifications, width by OpenSfM's list; the lens by its name"},
    CameraRow{"dji_zenmuse_xt2_thermal_13mm", "DJI", "Zenmuse XT2, thermal camera, lens of 13 mm", 640, 512, 10.88,
              8.704, 13,
              "DJI, Zenmuse XT2 specifications: pixels of 17 um, width by OpenSfM's list; the lens by its name"},
    CameraRow{"flir_duo_pro_r_640_19mm", "FLIR", "Duo Pro R 640, thermal camera, lens of 19 mm", 640, 512, 10.88, 8.704,
              19, "FLIR, Duo Pro R specifications: pixels of 17 um, by QGroundControl's list"},
    CameraRow{"micasense_altum", "MicaSense", "Altum, multispectral cameras", 2064, 1544, 7.1208, 5.3268, 8, kAltum},
    CameraRow{"micasense_altum_thermal", "MicaSense", "Altum, thermal camera", 160, 120, 1.92, 1.44, 1.77,
              "MicaSense, metadata of its pictures: pixels of 12 um, 1.77 mm"},
    CameraRow{"micasense_rededge_m", "MicaSense", "RedEdge-M", 1280, 960, 4.8, 3.6, 5.4,
              "MicaSense, RedEdge-M Integration Guide, revision 02, section 3"},
    CameraRow{"parrot_sequoia_mono", "Parrot", "Sequoia, a monochrome camera", 1280, 960, 4.8, 3.6, 4,
              "Parrot, Sequoia specifications, by QGroundControl's list"},
    CameraRow{"parrot_sequoia_rgb", "Parrot", "Sequoia, RGB camera", 4608, 3456, 6.17, 4.63, 4.9,
              "Parrot, Sequoia specifications, by QGroundControl's list"},
    CameraRow{"phase_one_ixm_100_35mm", "Phase One", "iXM-100, lens of 35 mm", 11664, 8750, 43.9, 32.9, 35, kIxm},
    CameraRow{"phase_one_ixm_100_80mm", "Phase One", "iXM-100, lens of 80 mm", 11664, 8750, 43.9, 32.9, 80, kIxm},
    CameraRow{"raspberry_pi_camera_2", "Raspberry Pi", "Camera Module 2", 3280, 2464, 3.68, 2.76, 3.04,
              "Raspberry Pi documentation, Camera, Hardware specification"},
    CameraRow{"raspberry_pi_hq_6mm", "Raspberry Pi", "HQ Camera, lens of 6 mm", 4056, 3040, 6.287, 4.712, 6,
              "Raspberry Pi documentation, Camera, Hardware specification; the lens by its name"},
    CameraRow{"ricoh_gr_ii", "Ricoh", "GR II", 4928, 3264, 23.7, 15.7, 18.3,
              "Ricoh, GR II specifications, by QGroundControl's list"},
    CameraRow{"sentera_65r_27mm", "Sentera", "65R, lens of 27.4 mm", 9344, 7000, 29.9, 22.4, 27.4,
              "Sentera, 65R specifications, by QGroundControl's list"},
    CameraRow{"sony_a6000_16mm", "Sony", "ILCE-6000, lens of 16 mm", 6000, 4000, 23.5, 15.6, 16,
              "Sony, ILCE-6000 specifications, by QGroundControl's list"},
    CameraRow{"sony_a6000_35mm", "Sony", "ILCE-6000, lens of 35 mm", 6000, 4000, 23.5, 15.6, 35,
              "Sony, ILCE-6000 specifications, by QGroundControl's list"},
    CameraRow{"sony_a7r_ii_21mm", "Sony", "ILCE-7RM2, lens of 21 mm", 7952, 5304, 35.9, 24, 21,
              "Sony, ILCE-7RM2 specifications, by QGroundControl's list"},
    CameraRow{"sony_a7r_ii_28mm", "Sony", "ILCE-7RM2, lens of 28 mm", 7952, 5304, 35.9, 24, 28,
              "Sony, ILCE-7RM2 specifications, by QGroundControl's list"},
    CameraRow{"sony_a7r_iii_35mm", "Sony", "ILCE-7RM3, lens of 35 mm", 7952, 5304, 35.9, 24, 35,
              "Sony, ILCE-7RM3 specifications, by QGroundControl's list"},
    CameraRow{"sony_a7r_iv_35mm", "Sony", "ILCE-7RM4, lens of 35 mm", 9504, 6336, 35.7, 23.8, 35,
              "Sony, ILCE-7RM4 specifications, by QGroundControl's list"},
    CameraRow{"sony_qx1_16mm", "Sony", "ILCE-QX1, lens of 16 mm", 5456, 3632, 23.2, 15.4, 16,
              "Sony, ILCE-QX1 specifications, by QGroundControl's list"},
    CameraRow{"sony_rx0", "Sony", "DSC-RX0", 4800, 3200, 13.2, 8.8, 7.7,
              "Sony, DSC-RX0 specifications, by QGroundControl's list"},
    CameraRow{"sony_rx100_ii", "Sony", "DSC-RX100M2, widest", 5472, 3648, 13.2, 8.8, 10.4,
              "Sony, DSC-RX100M2 specifications, by QGroundControl's list"},
    CameraRow{"sony_rx1r_ii", "Sony", "DSC-RX1RM2", 7952, 5304, 35.9, 24, 35,
              "Sony, DSC-RX1RM2 specifications, by QGroundControl's list"},
};

std::vector<Camera> cameras_of_rows() {
  std::vector<Camera> cameras;
  cameras.reserve(kCameraRows.size());
  for (const CameraRow& row : kCameraRows) {
    cameras.push_back({row.name, row.maker, row.model, row.width_px, row.height_px, row.sensor_width_mm,
                       row.sensor_height_mm, row.focal_length_mm, row.source});
  }
  return cameras;
}

/// The names that `word` may stand for, most likely first: those that it is a part of, then those that are spelt alike.
std::vector<std::string_view> likely_names(std::string_view word) {
  constexpr std::size_t kMost = 3, kLongestWord = 100;  // more characters are no slip, and cost time
  word = word.substr(0, kLongestWord);
  std::string lower(word);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c == ' ' || c == '-' ? '_' : c;
  std::vector<std::string_view> names;
  for (const CameraRow& row : kCameraRows) names.emplace_back(row.name);
  const auto order = [&](std::string_view name) {
    const bool is_part = !lower.empty() && name.find(lower) != std::string_view::npos;
    return std::pair(!is_part, edit_distance(lower, name));
  };
  std::stable_sort(names.begin(), names.end(),
                   [&](std::string_view a, std::string_view b) { return order(a) < order(b); });
  names.resize(std::min(names.size(), kMost));
  return names;
}

}  // namespace

const std::vector<Camera>& known_cameras() {
  static const std::vector<Camera> cameras = cameras_of_rows();
  return cameras;
}

const Camera& find_camera(std::string_view name) {
  const std::vector<Camera>& cameras = known_cameras();
  const auto found = std::find_if(cameras.begin(), cameras.end(), [&](const Camera& c) { return c.name == name; });
  if (found != cameras.end()) return *found;
  std::string likely;
  for (const std::string_view candidate : likely_names(name)) {
    likely.append(likely.empty() ? "" : ", ").append(candidate);
  }
  throw Error(ErrorCode::unknown_choice, "there is no camera " + in_quotes(name) + " in the table", "",
              "the names most alike are " + likely + "; 'vantage cameras' lists all");
}

}  // namespace vantage
