// The table of cameras. A number is here only if a document of the maker or a picture's metadata has it, read or as
// others quote it; "by" names a list that does: docs/camera.md. Names: maker, model, and the lens where it can be
// chosen.
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/input.h"
#include "vantage/camera.h"
#include "vantage/error.h"

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
// Sensors of type 1/1.3 of 48 megapixels, of which each four make one of 2.4 um. Planners and Meshroom have 9.7 mm.
constexpr double kWidth13 = 9.6768, kHeight13 = 7.2576;
constexpr const char* kType13 =
    "DJI, metadata of its pictures: 6.72 mm, by lensfun and lists of planners; sensor of type 1/1.3: pixels of 2.4 um";
// 70 mm as of 35 mm film, on that sensor.
constexpr double kFocal70 = 19.57;
constexpr const char* kL2d = "DJI, metadata of its pictures: 12.29 mm, by lensfun; sensor of type 4/3: 17.3 x 13 mm";
constexpr const char* kThermal =
    "DJI, metadata of its pictures: 9.1 mm, 40 mm as of 35 mm film, by lists of planners; pixels of 12 um";
constexpr const char* kSkydio =
    "Skydio, 2, 2+ and X2 camera and metadata overview: 2376.56 pixels; sensor IMX577: pixels of 1.55 um";
constexpr const char* kA6100 = "Sony, ILCE-6100 specifications, width by AliceVision's list; the lens by its name";
constexpr const char* kIlx = "Sony, ILX-LR1 specifications, by a list of planners; the lens by its name";

constexpr std::array kCameraRows = {
    CameraRow{"autel_evo_ii", "Autel", "EVO II (8K)", 8000, 6000, 6.4, 4.8, 4.73,
              "Autel, EVO II specifications: type 1/2, 25.6 mm as of 35 mm film"},
    CameraRow{"autel_evo_ii_pro", "Autel", "EVO II Pro (XT705)", 5472, 3648, 13.1328, 8.7552, 10.57,
              "Autel, metadata of its pictures: 10.57 mm, 4404.17 pixels, so pixels of 2.4 um"},
    CameraRow{"canon_eos_m_22mm", "Canon", "EOS M, lens of 22 mm", 5184, 3456, 22.3, 14.9, 22,
              "Canon, EOS M specifications, by QGroundControl's list"},
    CameraRow{"canon_g9_x", "Canon", "PowerShot G9 X, widest", 5488, 3680, 13.2, 8.8, 10.2,
              "Canon, PowerShot G9 X specifications, by QGroundControl's list"},
    CameraRow{"canon_sx260_hs", "Canon", "PowerShot SX260 HS, widest", 4000, 3000, 6.17, 4.55, 4.5,
              "Canon, PowerShot SX260 HS specifications, by QGroundControl's list"},
    CameraRow{"dji_air_2s", "DJI", "Air 2S", 5472, 3648, 13.2, 8.8, 8.38,
              "DJI, metadata of its pictures: 8.38 mm, by lensfun; sensor of type 1: 13.2 x 8.8 mm"},
    CameraRow{"dji_air_3_medium_tele", "DJI", "Air 3, medium tele camera, 12 megapixels", 4032, 3024, kWidth13,
              kHeight13, kFocal70,
              "DJI, Air 3 specifications: type 1/1.3, 70 mm as of 35 mm film, by planners that cite them"},
    CameraRow{"dji_air_3_wide", "DJI", "Air 3, wide camera, 12 megapixels", 4032, 3024, kWidth13, kHeight13, 6.72,
              "DJI, Air 3: 6.72 mm, by YMapper's list; sensor of type 1/1.3: pixels of 2.4 um"},
    CameraRow{"dji_air_3s_medium_tele", "DJI", "Air 3S, medium tele camera, 12 megapixels", 4032, 3024, kWidth13,
              kHeight13, kFocal70,
              "DJI, Air 3S specifications: type 1/1.3, 70 mm as of 35 mm film, by a planner that cites them"},
    CameraRow{
        "dji_air_3s_wide", "DJI", "Air 3S, wide camera, 12 megapixels", 4096, 3072, 13.1072, 9.8304, 9.09,
        "DJI, Air 3S specifications: type 1, 24 mm as of 35 mm film, by programs that cite them; pixels of 3.2 um"},
    CameraRow{"dji_matrice_30_wide", "DJI", "Matrice 30 and 30T, wide camera", 4000, 3000, 6.4, 4.8, 4.5,
              "DJI, Matrice 30 specifications: type 1/2, 4.5 mm, by lists of planners"},
    CameraRow{"dji_matrice_30t_thermal", "DJI", "Matrice 30T, thermal camera", 640, 512, 7.68, 6.144, 9.1, kThermal},
    CameraRow{"dji_matrice_4t_thermal", "DJI", "Matrice 4T, thermal camera", 640, 512, 7.68, 6.144, 12,
              "DJI, Matrice 4T specifications: pixels of 12 um, 12 mm, by a list of planners"},
    CameraRow{"dji_matrice_4t_wide", "DJI", "Matrice 4T, wide camera, 12 megapixels", 4032, 3024, kWidth13, kHeight13,
              6.72, kType13},
    CameraRow{"dji_mavic_2_pro", "DJI", "Mavic 2 Pro (Hasselblad L1D-20c)", 5472, 3648, 13.2, 8.8, 10.26,
              "DJI, metadata of its pictures: 10.26 mm; sensor of type 1: 13.2 x 8.8 mm"},
    CameraRow{"dji_mavic_3_classic", "DJI", "Mavic 3 and Mavic 3 Classic (Hasselblad L2D-20c)", 5280, 3956, 17.3, 13.0,
              12.29, kL2d},
    CameraRow{
        "dji_mavic_3_pro_medium_tele", "DJI", "Mavic 3 Pro, medium tele camera, 12 megapixels", 4032, 3024, kWidth13,
        kHeight13, kFocal70,
        "DJI, Mavic 3 Pro specifications: type 1/1.3, 70 mm as of 35 mm film, by programs that cite them; pixels by "
        "OpenAthena's list"},
    CameraRow{"dji_mavic_3_pro_wide", "DJI", "Mavic 3 Pro, wide camera (Hasselblad L2D-20c)", 5280, 3956, 17.3, 13.0,
              12.29, kL2d},
    CameraRow{"dji_mavic_3e_tele", "DJI", "Mavic 3E and 3T, tele camera", 4000, 3000, 6.4, 4.8, 29.85,
              "DJI, Mavic 3E specifications: type 1/2, 162 mm as of 35 mm film; 29.85 mm by a list of planners"},
    CameraRow{"dji_mavic_3e_wide", "DJI", "Mavic 3E, wide camera", 5280, 3956, 17.3, 13.0, 12.29,
              "DJI, metadata of its pictures: 12.29 mm; sensor of type 4/3: 17.3 x 13 mm"},
    CameraRow{"dji_mavic_3t_thermal", "DJI", "Mavic 3T, thermal camera", 640, 512, 7.68, 6.144, 9.1, kThermal},
    CameraRow{"dji_mavic_3t_wide", "DJI", "Mavic 3T, wide camera, 12 megapixels", 4000, 3000, 6.4, 4.8, 4.4,
              "DJI, metadata of its pictures: 4.4 mm, 24 mm as of 35 mm film; type 1/2, by lists of planners"},
    CameraRow{"dji_mini_3", "DJI", "Mini 3", 4000, 3000, 9.6, 7.2, 6.72,
              "DJI, metadata of its pictures: 6.72 mm, by planners, 6.7 mm by OpenAthena's list; sensor of type 1/1.3: "
              "pixels of 2.4 um"},
    CameraRow{"dji_mini_3_pro", "DJI", "Mini 3 Pro, 12 megapixels", 4032, 3024, kWidth13, kHeight13, 6.72, kType13},
    CameraRow{"dji_mini_4_pro", "DJI", "Mini 4 Pro, 12 megapixels", 4032, 3024, kWidth13, kHeight13, 6.72, kType13},
    CameraRow{"dji_phantom_4_pro", "DJI", "Phantom 4 Pro", 5472, 3648, 13.2, 8.8, 8.8, kPhantom},
    CameraRow{"dji_phantom_4_rtk", "DJI", "Phantom 4 RTK", 5472, 3648, 13.2, 8.8, 8.8, kPhantom},
    CameraRow{"dji_zenmuse_h20_wide", "DJI", "Zenmuse H20 and H20T, wide camera", 4056, 3040, 6.287, 4.712, 4.5,
              "DJI, Zenmuse H20 specifications: type 1/2.3, 4.5 mm, by a list of planners; pixels of 1.55 um"},
    CameraRow{"dji_zenmuse_h20t_thermal", "DJI", "Zenmuse H20T, thermal camera", 640, 512, 7.68, 6.144, 13.5,
              "DJI, Zenmuse H20T specifications: pixels of 12 um, 13.5 mm, width by OpenSfM's list"},
    CameraRow{"dji_zenmuse_h30_wide", "DJI", "Zenmuse H30 and H30T, wide camera, 12 megapixels", 4032, 3024, kWidth13,
              kHeight13, 6.72, kType13},
    CameraRow{"dji_zenmuse_h30t_thermal", "DJI", "Zenmuse H30T, thermal camera", 1280, 1024, 15.36, 12.288, 23.6,
              "DJI, Zenmuse H30T specifications: 45.2 degrees from corner to corner, by a planner; pixels of 12 um"},
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
    CameraRow{"skydio_2", "Skydio", "2 and 2+", 4056, 3040, 6.2868, 4.712, 3.683, kSkydio},
    CameraRow{"skydio_x10_narrow", "Skydio", "X10, narrow camera", 9248, 6944, 7.3984, 5.5804, 10.1347,
              "Skydio, X10 camera and metadata overview: 12668.35 and 12611.03 pixels, pixels of 0.8 um"},
    CameraRow{"skydio_x10_wide", "Skydio", "X10, wide camera of VT300-L", 8192, 6144, 13.1072, 9.8304, 7.898,
              "Skydio, metadata of its pictures: 4936 pixels, pixels of 1.6 um, by a planner"},
    CameraRow{"skydio_x2", "Skydio", "X2, color", 4056, 3040, 6.2868, 4.712, 3.683, kSkydio},
    CameraRow{"skydio_x2_color_thermal", "Skydio", "X2 color/thermal, color camera", 4056, 3040, 6.2868, 4.7274, 7.5147,
              "Skydio, 2, 2+ and X2 camera and metadata overview: 4848.19 and 4832.34 pixels; pixels of 1.55 um"},
    CameraRow{"sony_a6000_16mm", "Sony", "ILCE-6000, lens of 16 mm", 6000, 4000, 23.5, 15.6, 16,
              "Sony, ILCE-6000 specifications, by QGroundControl's list"},
    CameraRow{"sony_a6000_35mm", "Sony", "ILCE-6000, lens of 35 mm", 6000, 4000, 23.5, 15.6, 35,
              "Sony, ILCE-6000 specifications, by QGroundControl's list"},
    CameraRow{"sony_a6100_16mm", "Sony", "ILCE-6100, lens of 16 mm", 6000, 4000, 23.5, 15.6, 16, kA6100},
    CameraRow{"sony_a6100_35mm", "Sony", "ILCE-6100, lens of 35 mm", 6000, 4000, 23.5, 15.6, 35, kA6100},
    CameraRow{"sony_a7r_ii_21mm", "Sony", "ILCE-7RM2, lens of 21 mm", 7952, 5304, 35.9, 24, 21,
              "Sony, ILCE-7RM2 specifications, by QGroundControl's list"},
    CameraRow{"sony_a7r_ii_28mm", "Sony", "ILCE-7RM2, lens of 28 mm", 7952, 5304, 35.9, 24, 28,
              "Sony, ILCE-7RM2 specifications, by QGroundControl's list"},
    CameraRow{"sony_a7r_iii_35mm", "Sony", "ILCE-7RM3, lens of 35 mm", 7952, 5304, 35.9, 24, 35,
              "Sony, ILCE-7RM3 specifications, by QGroundControl's list"},
    CameraRow{"sony_a7r_iv_35mm", "Sony", "ILCE-7RM4, lens of 35 mm", 9504, 6336, 35.7, 23.8, 35,
              "Sony, ILCE-7RM4 specifications, by QGroundControl's list"},
    CameraRow{"sony_ilx_lr1_24mm", "Sony", "ILX-LR1, lens of 24 mm", 9504, 6336, 35.7, 23.8, 24, kIlx},
    CameraRow{"sony_ilx_lr1_35mm", "Sony", "ILX-LR1, lens of 35 mm", 9504, 6336, 35.7, 23.8, 35, kIlx},
    CameraRow{"sony_qx1_16mm", "Sony", "ILCE-QX1, lens of 16 mm", 5456, 3632, 23.2, 15.4, 16,
              "Sony, ILCE-QX1 specifications, by QGroundControl's list"},
    CameraRow{"sony_rx0", "Sony", "DSC-RX0", 4800, 3200, 13.2, 8.8, 7.7,
              "Sony, DSC-RX0 specifications, by QGroundControl's list"},
    CameraRow{"sony_rx100_ii", "Sony", "DSC-RX100M2, widest", 5472, 3648, 13.2, 8.8, 10.4,
              "Sony, DSC-RX100M2 specifications, by QGroundControl's list"},
    CameraRow{"sony_rx1r_ii", "Sony", "DSC-RX1RM2", 7952, 5304, 35.9, 24, 35,
              "Sony, DSC-RX1RM2 specifications, by QGroundControl's list"},
};

using Range = CameraCarrier::Range;
constexpr std::nullopt_t kNotKnown = std::nullopt;

struct Aircraft {
  std::optional<int> drone, sub_type, payload;
  std::optional<double> climb_m_s, descent_m_s, speed_m_s;
};

/// Of all cameras whose names begin so; the first that fits.
struct CarrierRow {
  std::string_view of;
  std::optional<Range> pitch_deg, roll_deg, yaw_deg;
  std::optional<double> rate_deg_s;
  Aircraft aircraft;
  const char* source;
};

constexpr const char* kEnterprise =
    "DJI, Mavic 3 Enterprise Series specifications: gimbal, aircraft; Cloud API, WPML, Common Elements: numbers";
constexpr const char* kM30 =
    "DJI, Payload SDK, Gimbal Management: gimbal; Matrice 30 Series specifications: aircraft; Cloud API, WPML, Common "
    "Elements: numbers";
constexpr const char* kPayload = "DJI, Payload SDK, Gimbal Management; Cloud API, WPML, Common Elements: number";
constexpr const char* kMini = "DJI, specifications of the Mini: gimbal, aircraft";
constexpr Range kEnterprisePitch = {-90, 35}, kMatricePitch = {-120, 45}, kMiniPitch = {-90, 60};

// Where a camera is one of two aircraft or payloads, it has no number, and the narrower range.
constexpr std::array kCarrierRows = {
    CarrierRow{"dji_air_2s",
               Range{-90, 24},
               kNotKnown,
               kNotKnown,
               100,
               {{}, {}, {}, 6, 6, 15},
               "DJI, Air 2S specifications: gimbal (extended), aircraft"},
    CarrierRow{"dji_air_3_",
               Range{-90, 60},
               kNotKnown,
               Range{-5, 5},
               100,
               {{}, {}, {}, 10, 10, 21},
               "DJI, Air 3 specifications: gimbal, aircraft"},
    CarrierRow{"dji_air_3s_",
               Range{-90, 60},
               kNotKnown,
               Range{-5, 5},
               100,
               {{}, {}, {}, 10, 10, 21},
               "DJI, Air 3S specifications: gimbal, aircraft"},
    CarrierRow{"dji_matrice_30_", kMatricePitch, Range{-50, 50}, kNotKnown, kNotKnown, {{}, {}, {}, 6, 5, 23}, kM30},
    CarrierRow{"dji_matrice_30t_", kMatricePitch, Range{-50, 50}, kNotKnown, kNotKnown, {67, 1, 53, 6, 5, 23}, kM30},
    CarrierRow{"dji_matrice_4t_",
               kNotKnown,
               kNotKnown,
               kNotKnown,
               kNotKnown,
               {99, 1, 89, {}, {}, {}},
               "DJI, Cloud API, Product Support: numbers"},
    CarrierRow{"dji_mavic_2_pro",
               Range{-90, 30},
               kNotKnown,
               Range{-75, 75},
               120,
               {{}, {}, {}, 4, 3, {}},
               "DJI, Mavic 2 specifications: gimbal, aircraft"},
    CarrierRow{"dji_mavic_3_",
               kEnterprisePitch,
               kNotKnown,
               Range{-5, 5},
               100,
               {{}, {}, {}, 6, 6, 15},
               "DJI, Mavic 3 specifications: gimbal, aircraft"},
    CarrierRow{"dji_mavic_3e_tele", kEnterprisePitch, kNotKnown, kNotKnown, 100, {{}, {}, {}, 6, 6, 15}, kEnterprise},
    CarrierRow{"dji_mavic_3e_", kEnterprisePitch, kNotKnown, kNotKnown, 100, {77, 0, 66, 6, 6, 15}, kEnterprise},
    CarrierRow{"dji_mavic_3t_", kEnterprisePitch, kNotKnown, kNotKnown, 100, {77, 1, 67, 6, 6, 15}, kEnterprise},
    CarrierRow{"dji_mini_3", kMiniPitch, kNotKnown, kNotKnown, 100, {{}, {}, {}, 3, 3, 10}, kMini},
    CarrierRow{"dji_mini_4_pro", kMiniPitch, kNotKnown, kNotKnown, 100, {{}, {}, {}, 5, 5, 12}, kMini},
    CarrierRow{"dji_phantom_4_",
               Range{-90, 30},
               kNotKnown,
               kNotKnown,
               90,
               {{}, {}, {}, 5, 3, 13.9},
               "DJI, Phantom 4 Pro and Phantom 4 RTK specifications: gimbal, aircraft in positioning mode"},
    CarrierRow{"dji_zenmuse_h20_", Range{-120, 30}, Range{-45, 45}, kNotKnown, kNotKnown, {}, kPayload},
    CarrierRow{
        "dji_zenmuse_h20t_", Range{-120, 30}, Range{-45, 45}, kNotKnown, kNotKnown, {{}, {}, 43, {}, {}, {}}, kPayload},
    CarrierRow{"dji_zenmuse_h30_", Range{-120, 60}, Range{-45, 45}, kNotKnown, kNotKnown, {}, kPayload},
    CarrierRow{
        "dji_zenmuse_h30t_", Range{-120, 60}, Range{-45, 45}, kNotKnown, kNotKnown, {{}, {}, 83, {}, {}, {}}, kPayload},
    CarrierRow{"dji_zenmuse_p1_", Range{-120, 30}, Range{-50, 50}, kNotKnown, kNotKnown, {}, kPayload},
    CarrierRow{"dji_zenmuse_xt2_", Range{-90, 30}, Range{-40, 40}, kNotKnown, kNotKnown, {}, kPayload},
};

CameraCarrier carrier_of(std::string_view name) {
  for (const CarrierRow& row : kCarrierRows) {
    if (!name.starts_with(row.of)) continue;
    const Aircraft& aircraft = row.aircraft;
    return {row.pitch_deg,        row.roll_deg,       row.yaw_deg,      row.rate_deg_s,
            aircraft.drone,       aircraft.sub_type,  aircraft.payload, aircraft.climb_m_s,
            aircraft.descent_m_s, aircraft.speed_m_s, row.source};
  }
  return {};
}

std::vector<Camera> cameras_of_rows() {
  std::vector<Camera> cameras;
  cameras.reserve(kCameraRows.size());
  for (const CameraRow& row : kCameraRows) {
    cameras.push_back({row.name, row.maker, row.model, row.width_px, row.height_px, row.sensor_width_mm,
                       row.sensor_height_mm, row.focal_length_mm, row.source, carrier_of(row.name)});
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
