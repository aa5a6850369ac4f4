// Pictures of a scene, its target and its volume: drawn by OpenGL off screen, annotated, ready for a paper.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {

/// Where a picture is taken from.
struct PictureView {
  enum class Kind {
    oblique,  ///< parallel projection from `azimuth_deg` and `elevation_deg`, framing the volume and the target
    top,      ///< parallel projection from above, north up
    from,     ///< perspective from `from`, looking at the target's centre
  };
  Kind kind = Kind::oblique;
  std::optional<double> azimuth_deg;  ///< from x (east), counter-clockwise, to where the camera is. Default: from where
                                      ///< the scene hides least of the target and the volume; the south-west if it may
  double elevation_deg = 45;          ///< above the horizon, -90 to 90
  Vec3 from = Vec3::Zero();           ///< scene frame, metres
};

/// Pixels that a picture may have each way.
inline constexpr int kSmallestPicture = 64, kLargestPicture = 4096;

/// Facets of the volume that a picture shows in a colour of their own: red, of a second group yellow, and so on in
/// turn.
struct MarkedFacets {
  std::string label;                  ///< for the legend
  std::vector<std::uint32_t> facets;  ///< by number; with none there is no entry in the legend
};

/// A line through the scene, as of a flight: drawn over everything, and paler behind the volume and the scene.
struct PicturePath {
  std::string label;                      ///< for the legend
  std::vector<Vec3> points;               ///< from each to the next; scene frame
  std::vector<std::vector<Vec3>> marked;  ///< stretches in a colour of their own, as where a target is seen
  std::string marked_label;               ///< for the legend; empty: they have no entry
};

/// What to draw, and how.
struct PictureRequest {
  const Target* target = nullptr;          ///< drawn where it is given, `offset_m` applied
  std::vector<const Target*> others = {};  ///< more targets, drawn as `target` is
  const Volume* volume = nullptr;          ///< its mesh, `cause_of` and `causes`; without causes it has one colour
  const Mesh* solid = nullptr;             ///< instead of a volume: any mesh, in one colour
  std::vector<const Mesh*> solids = {};  ///< more of them, paler and each in a colour of its own, as of several volumes
  std::vector<MarkedFacets> marks = {};  ///< with any, causes do not count: all else of the volume has one colour
  std::vector<PicturePath> paths = {};
  Navigation navigation;  ///< its boxes and zones are drawn as thin lines
  PictureView view;
  int width = 1600, height = 1200;  ///< pixels, kSmallestPicture to kLargestPicture
  bool draw_scene = true;
  bool annotate = true;            ///< title, legend, scale bar, north arrow
  std::string title, subtitle;     ///< UTF-8
  std::vector<std::string> notes;  ///< what to know before relying on it, as Volume::notes: written under the subtitle
  std::vector<Vec3> frame;         ///< what the picture must hold. Empty: volume, solids, targets, paths, boxes
};

/// Rows from the top, four bytes a pixel: red, green, blue (sRGB), and opacity, which is 255 everywhere.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Where attribution_of the scene names somebody, the picture does so too, annotated or not.
///
/// Draws with the first graphics processor, or without one with OpenGL that the processor emulates. The same request on
/// the same machine gives the same bytes. Throws Error(input) where there is no OpenGL 4.5 (with what to install), and
/// for a size out of range, a view or meshes that make no sense; Error(cancelled) when told to stop. Cost: some
/// seconds where OpenGL is emulated, in proportion to the pixels and to the triangles near the volume.
VANTAGE_API Picture render_picture(const Scene& scene, const PictureRequest& request, const Progress& progress = {});

/// A panel of a figure sheet.
struct PicturePanel {
  Picture picture;
  std::string caption;  ///< UTF-8, one line
};

/// Panels in rows, lettered (a), (b), ..., with their captions underneath and a title on top. All panels must have the
/// size of the first; Error(input) otherwise, or when there is none.
VANTAGE_API Picture arrange_sheet(const std::vector<PicturePanel>& panels, int columns, const std::string& title,
                                  const std::string& subtitle);

/// A row under a profile.
struct ProfileStrip {
  std::string label;                           ///< UTF-8
  std::vector<std::array<double, 2>> spans_m;  ///< along the flight, from and to: filled
};

/// The profile of a flight: its height, and the scene below it, over the way along it.
struct ProfileRequest {
  std::vector<Vec3> points;          ///< of the flight, from each to the next; scene frame, at least two
  std::vector<ProfileStrip> strips;  ///< as when each target is seen
  int width = 1600;                  ///< pixels, kSmallestPicture to kLargestPicture; the height follows
  double height_zero_m = 0;          ///< z of the scene frame that is called 0
  std::string height_label = "height, m";
  std::string title, subtitle;  ///< UTF-8
};

/// Drawn without OpenGL. Under the flight the highest surface of the scene is shown, looked up once a pixel. Strips for
/// which the picture would be higher than half of kLargestPicture are left out, and a line says how many. A span is at
/// least 1.5 pixels wide. Throws Error(input) for fewer than two points, one that is not finite, spans that are not
/// finite, and a width out of range; Error(cancelled).
VANTAGE_API Picture render_profile(const Scene& scene, const ProfileRequest& request, const Progress& progress = {});

/// One picture over another, in the middle of what the wider one takes. Throws Error(input) where together they are
/// higher than kLargestPicture.
VANTAGE_API Picture stack_pictures(const Picture& upper, const Picture& lower);

/// PNG, 8 bits a channel. Written whole or not at all; throws Error(output), Error(input) as AtomicFile does, and
/// Error(cancelled) when told to stop.
VANTAGE_API void write_png(const Picture& picture, const std::filesystem::path& file, const Progress& progress = {});

}  // namespace vantage
