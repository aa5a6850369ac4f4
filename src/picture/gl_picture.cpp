// Each frame: shadow maps of its lights, the scene into images of depth, normal and colour, these shaded; the volume's
// first layers by depth peeling (C. Everitt, Interactive Order-Independent Transparency, 2001), blended from front to
// back, and all layers behind them at once, in their mean colour; lines last.
#include "picture/gl_picture.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <numbers>

#include "core/stopwatch.h"
#include "depth/gl_objects.h"
#include "picture/coarse_triangles.h"
#include "picture/gl_picture_shaders.h"
#include "vantage/error.h"

namespace vantage::internal::picture {
namespace {

constexpr int kSky = 9, kSun = 2;  // lights of a frame, as in the shaders
constexpr int kSkyMapSize = 512, kSunMapSize = 2048;
constexpr std::size_t kManySolids = 100'000;  // triangles of the scene, from which on the sky's shadows are simplified
constexpr int kMostLayers = 12;               // of the volume that are peeled: a fifth of the light comes from behind
constexpr int kLeastLayers = 3;               // of a volume of very many facets, which are drawn anew for each layer
constexpr std::size_t kPeeledFacets = 800'000;  // in a frame
constexpr double kSunRadius = 0.035;            // radians: softens the shadows

// Sixteenths of a pixel: no two in a row or a column (the standard pattern of eight).
constexpr std::array<std::array<int, 2>, 8> kShifts = {
    {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}};
constexpr int kFrames = static_cast<int>(kShifts.size());

// Where the processor draws, whatever waits to be drawn must be done before a picture can be given up.
constexpr GLsizei kPartVertices = 6 << 13;  // drawn at a time: whole triangles, and whole lines
constexpr int kPartPixels = 1 << 18;        // likewise, of passes over all pixels
constexpr double kMostQueueSeconds = 0.04;  // of work that is handed over before it is waited for
constexpr GLuint64 kGlance = 10'000'000;    // nanoseconds

/// As `Frame` in the shaders (std140).
struct FrameBlock {
  Eigen::Matrix4f clip, unclip;
  Eigen::Vector4f eye, back, fade, size, bias, offset;
  std::array<Eigen::Vector4f, kSky + kSun> light;
  std::array<Eigen::Matrix4f, kSky + kSun> light_clip;
};

/// A corner of a line's rectangle.
struct LineVertex {
  Eigen::Vector3f a, b;
  std::uint32_t colour;
  Eigen::Vector3f style;
};

struct Batch {
  GLuint array = 0;
  GLsizei count = 0;  ///< vertices
};

/// Point `index` of `count` spread evenly over the upper half of the unit sphere (a spiral by the golden angle).
Eigen::Vector3f sky_direction(int index, int count) {
  const double z = (index + 0.5) / count, r = std::sqrt(1 - z * z);
  const double angle = index * std::numbers::pi * (3 - std::sqrt(5.0));
  return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
}

/// Point `index` of `count` spread over the sun's disc.
Eigen::Vector3f sun_direction(const Eigen::Vector3f& sun, int index, int count) {
  const Eigen::Vector3f u = sun.unitOrthogonal(), v = sun.cross(u);
  const double r = kSunRadius * std::sqrt((index + 0.5) / count);
  const double angle = index * std::numbers::pi * (3 - std::sqrt(5.0));
  return (sun + static_cast<float>(r * std::cos(angle)) * u + static_cast<float>(r * std::sin(angle)) * v).normalized();
}

/// To [-1, 1] across the light and depth 1 (nearest to it) to 0, of a ball.
Eigen::Matrix4f light_matrix(const Eigen::Vector3f& towards, const Eigen::Vector3f& centre, float radius) {
  const Eigen::Vector3f u = towards.unitOrthogonal(), v = towards.cross(u);
  Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
  matrix.row(0) << u.transpose() / radius, -u.dot(centre) / radius;
  matrix.row(1) << v.transpose() / radius, -v.dot(centre) / radius;
  matrix.row(2) << towards.transpose() / (2 * radius), 0.5F - towards.dot(centre) / (2 * radius);
  return matrix;
}

Eigen::Vector4f four(const Eigen::Vector3f& v, float w) { return {v.x(), v.y(), v.z(), w}; }

class Painter {
 public:
  Painter(const depth::GlContext& context, const DrawList& list, const View& view,
          const core::ProgressReporter& progress)
      : context_(context), gl_(context.gl()), list_(list), view_(view), progress_(progress), objects_(context) {
    programs();
    images();
    solids_ = triangles(list.solids);
    skylit_ = skylit();
    volume_ = triangles(list.volume);
    target_ = triangles(list.target);
    ground_lines_ = lines(list.ground_lines);
    creases_ = lines(list.creases);
    lines_ = lines(list.lines);
    const std::size_t facets = std::max<std::size_t>(list.volume.size() / 3, 1);
    layers_ = static_cast<int>(std::clamp<std::size_t>(kPeeledFacets / facets, kLeastLayers, kMostLayers));
    screen_ = objects_.vertex_array();
    frame_block_ = objects_.buffer(nullptr, sizeof(FrameBlock), GL_DYNAMIC_DRAW);
    layer_query_ = objects_.query();
    context_.check("uploading what a picture shows");
  }

  std::vector<std::uint8_t> paint() {
    gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_);
    gl_.DepthFunc(GL_GREATER);
    clear(sum_target_, 0);
    for (int frame = 0; frame < kFrames; ++frame) {
      paint_frame(frame);
      context_.check("drawing a picture");
    }
    settle();
    return read();
  }

 private:
  void programs() {
    using namespace shaders;
    const auto program = [&](const char* name, const char* vertex, const char* fragment) {
      return objects_.program(name, {vertex, nullptr, fragment, kHeader});
    };
    solid_program_ = program("scenes", kSolidVertex, kSolidFragment);
    shadow_program_ = program("shadows", kShadowVertex, kShadowFragment);
    shade_program_ = program("light", kScreenVertex, kShadeFragment);
    film_program_ = program("volumes", kFilmVertex, kFilmFragment);
    copy_program_ = program("copies", kScreenVertex, kCopyFragment);
    layer_program_ = program("layers", kScreenVertex, kLayerFragment);
    rest_program_ = program("volumes behind", kFilmVertex, kRestFragment);
    mean_program_ = program("layers behind", kScreenVertex, kMeanFragment);
    target_program_ = program("targets", kTargetVertex, kTargetFragment);
    line_program_ = program("lines", kLineVertex, kLineFragment);
    which_ = gl_.GetUniformLocation(shadow_program_, "which");
    fades_ = gl_.GetUniformLocation(line_program_, "fades");
  }

  void images() {
    const int w = view_.width, h = view_.height;
    depth_ = objects_.texture(GL_DEPTH_COMPONENT32F, w, h);
    normal_ = objects_.texture(GL_RGBA16F, w, h);
    albedo_ = objects_.texture(GL_RGBA8, w, h);
    image_ = objects_.texture(GL_RGBA16F, w, h);
    layer_ = objects_.texture(GL_RGBA8, w, h);
    film_ = objects_.texture(GL_RGBA16F, w, h);
    sum_ = objects_.texture(GL_RGBA32F, w, h);
    scene_target_ = objects_.framebuffer({normal_, albedo_}, depth_);
    image_target_ = objects_.framebuffer({image_}, 0);
    film_target_ = objects_.framebuffer({film_}, 0);
    rest_ = objects_.texture(GL_RGBA16F, w, h);
    rest_target_ = objects_.framebuffer({rest_}, 0);
    sum_target_ = objects_.framebuffer({sum_}, 0);
    for (std::size_t i = 0; i < layer_depths_.size(); ++i) {
      layer_depths_[i] = objects_.texture(GL_DEPTH_COMPONENT32F, w, h);
      layer_targets_[i] = objects_.framebuffer({layer_}, layer_depths_[i]);
    }
    nothing_before_ = objects_.texture(GL_DEPTH_COMPONENT32F, w, h);
    const GLuint before_target = objects_.framebuffer({}, nothing_before_);
    const GLfloat one = 1;
    gl_.ClearNamedFramebufferfv(before_target, GL_DEPTH, 0, &one);
    sky_maps_ = objects_.shadow_maps(kSkyMapSize, kSky);
    sun_maps_ = objects_.shadow_maps(kSunMapSize, kSun);
    shadow_target_ = objects_.framebuffer();
    gl_.NamedFramebufferDrawBuffer(shadow_target_, GL_NONE);
  }

  Batch batch(const void* data, std::size_t stride, std::size_t count) {
    Batch batch{objects_.vertex_array(), static_cast<GLsizei>(count)};
    if (count > 0) {
      const GLuint buffer = objects_.buffer(data, stride * count, GL_STATIC_DRAW);
      gl_.VertexArrayVertexBuffer(batch.array, 0, buffer, 0, static_cast<GLsizei>(stride));
    }
    return batch;
  }

  void attribute(const Batch& batch, GLuint location, GLint size, GLenum type, std::size_t offset) {
    gl_.EnableVertexArrayAttrib(batch.array, location);
    gl_.VertexArrayAttribFormat(batch.array, location, size, type, type == GL_UNSIGNED_BYTE ? GL_TRUE : GL_FALSE,
                                static_cast<GLuint>(offset));
    gl_.VertexArrayAttribBinding(batch.array, location, 0);
  }

  Batch triangles(const std::vector<DrawVertex>& vertices) {
    const Batch result = batch(vertices.data(), sizeof(DrawVertex), vertices.size());
    attribute(result, 0, 3, GL_FLOAT, offsetof(DrawVertex, position));
    attribute(result, 1, 3, GL_FLOAT, offsetof(DrawVertex, normal));
    attribute(result, 2, 4, GL_UNSIGNED_BYTE, offsetof(DrawVertex, colour));
    return result;
  }

  /// What keeps the light of the sky away. Its shadows are rough, so that less than all will do where there is much.
  Batch skylit() {
    if (list_.solids.size() / 3 < kManySolids) return solids_;
    const float texel = 2 * list_.light_radius / kSkyMapSize;
    const std::vector<Eigen::Vector3f> corners = coarse_triangles(list_.solids, 0.5F * texel, progress_);
    const Batch result = batch(corners.data(), sizeof(Eigen::Vector3f), corners.size());
    attribute(result, 0, 3, GL_FLOAT, 0);
    return result;
  }

  Batch lines(const std::vector<DrawLine>& lines) {
    std::vector<LineVertex> vertices;
    vertices.reserve(6 * lines.size());
    for (const DrawLine& line : lines) {
      vertices.insert(vertices.end(), 6,
                      {line.a, line.b, line.colour, {line.width, line.behind_volume, line.behind_scene}});
    }
    const Batch result = batch(vertices.data(), sizeof(LineVertex), vertices.size());
    attribute(result, 0, 3, GL_FLOAT, offsetof(LineVertex, a));
    attribute(result, 1, 3, GL_FLOAT, offsetof(LineVertex, b));
    attribute(result, 2, 4, GL_UNSIGNED_BYTE, offsetof(LineVertex, colour));
    attribute(result, 3, 3, GL_FLOAT, offsetof(LineVertex, style));
    return result;
  }

  void clear(GLuint target, float value, int images = 1) {
    const std::array<GLfloat, 4> colour = {value, value, value, value};
    for (int i = 0; i < images; ++i) gl_.ClearNamedFramebufferfv(target, GL_COLOR, i, colour.data());
  }

  void clear_depth(GLuint target) {
    const GLfloat zero = 0;
    gl_.ClearNamedFramebufferfv(target, GL_DEPTH, 0, &zero);
  }

  void draw(GLuint program, const Batch& batch) {
    if (batch.count == 0) return;
    gl_.UseProgram(program);
    gl_.BindVertexArray(batch.array);
    for (GLsizei first = 0; first < batch.count; first += kPartVertices) {
      gl_.DrawArrays(GL_TRIANGLES, first, std::min(kPartVertices, batch.count - first));
      pace();
    }
  }

  /// Runs a program for all pixels of the target.
  void fill(GLuint program) {
    gl_.UseProgram(program);
    gl_.BindVertexArray(screen_);
    const int rows = std::max(1, kPartPixels / view_.width);
    for (int row = 0; row < view_.height; row += rows) {
      gl_.Viewport(0, row, view_.width, std::min(rows, view_.height - row));
      gl_.DrawArrays(GL_TRIANGLES, 0, 3);
      pace();
    }
    gl_.Viewport(0, 0, view_.width, view_.height);
  }

  void pace() {
    progress_.check();
    if (queued_.seconds() > kMostQueueSeconds) settle();
  }

  /// Waits until all is drawn.
  void settle() {
    GLsync fence = gl_.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    const auto end = [&] { gl_.DeleteSync(fence); };
    try {
      while (gl_.ClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kGlance) == GL_TIMEOUT_EXPIRED) {
        progress_.check();
      }
    } catch (...) {
      end();
      throw;
    }
    end();
    queued_ = {};
  }

  void begin(GLuint target, bool with_depth) {
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    gl_.Viewport(0, 0, view_.width, view_.height);
    if (with_depth) {
      gl_.Enable(GL_DEPTH_TEST);
    } else {
      gl_.Disable(GL_DEPTH_TEST);
    }
    gl_.Disable(GL_BLEND);
  }

  void blend(GLenum source, GLenum destination) {
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(source, destination);
  }

  void set_frame(int frame) {
    FrameBlock block;
    const auto& shift = kShifts[static_cast<std::size_t>(frame)];
    block.clip = view_.clip(list_.origin, {shift[0] / 16.0, shift[1] / 16.0});
    block.unclip = block.clip.cast<double>().inverse().cast<float>();
    block.eye = four((view_.eye - list_.origin).cast<float>(), view_.perspective ? 1 : 0);
    block.back = four(view_.back.cast<float>(), static_cast<float>(view_.focus_m));
    block.fade << list_.focus.x(), list_.focus.y(), list_.fade_begin, list_.fade_end;
    block.size << static_cast<float>(view_.width), static_cast<float>(view_.height), static_cast<float>(frame), kFrames;
    const double pixel = 1 / (view_.pixels_per_metre() * view_.focus_m);  // a pixel's size over the distance
    block.bias << static_cast<float>(0.15 * pixel), static_cast<float>(2.5 * pixel), static_cast<float>(1.0 * pixel), 0;
    const float radius = list_.light_radius;
    block.offset << 2 * radius / kSkyMapSize, 3 * radius / kSunMapSize, 0, 0;
    for (int i = 0; i < kSky + kSun; ++i) {
      const Eigen::Vector3f towards = i < kSky ? sky_direction(i * kFrames + frame, kSky * kFrames)
                                               : sun_direction(list_.sun, (i - kSky) * kFrames + frame, kSun * kFrames);
      const auto at = static_cast<std::size_t>(i);
      block.light[at] = four(towards, 0);
      block.light_clip[at] = light_matrix(towards, list_.light_centre, radius);
    }
    gl_.NamedBufferSubData(frame_block_, 0, sizeof(block), &block);
  }

  void shadows() {
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, shadow_target_);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.Enable(GL_DEPTH_CLAMP);
    gl_.Disable(GL_BLEND);
    for (int i = 0; i < kSky + kSun; ++i) {
      const int size = i < kSky ? kSkyMapSize : kSunMapSize;
      gl_.NamedFramebufferTextureLayer(shadow_target_, GL_DEPTH_ATTACHMENT, i < kSky ? sky_maps_ : sun_maps_, 0,
                                       i < kSky ? i : i - kSky);
      gl_.Viewport(0, 0, size, size);
      clear_depth(shadow_target_);
      gl_.ProgramUniform1i(shadow_program_, which_, i);
      draw(shadow_program_, i < kSky ? skylit_ : solids_);
    }
    gl_.Disable(GL_DEPTH_CLAMP);
  }

  void scene() {
    begin(scene_target_, true);
    clear(scene_target_, 0, 2);
    clear_depth(scene_target_);
    draw(solid_program_, solids_);

    begin(image_target_, false);
    gl_.BindTextureUnit(0, depth_);
    gl_.BindTextureUnit(1, normal_);
    gl_.BindTextureUnit(2, albedo_);
    gl_.BindTextureUnit(3, sky_maps_);
    gl_.BindTextureUnit(4, sun_maps_);
    fill(shade_program_);

    blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    clear_depth(layer_targets_[0]);
    gl_.BindTextureUnit(1, layer_depths_[0]);
    gl_.ProgramUniform1f(line_program_, fades_, 1);
    draw(line_program_, ground_lines_);
  }

  /// Layer 0 keeps its depths for the lines; the others take turns.
  void films() {
    clear_depth(layer_targets_[0]);
    if (volume_.count == 0) return;
    clear(film_target_, 0);
    GLuint before = nothing_before_;
    for (int layer = 0;; ++layer) {
      if (layer == layers_) {
        rest(before);
        break;
      }
      const std::size_t at = layer == 0 ? 0 : static_cast<std::size_t>(1 + layer % 2);
      begin(layer_targets_[at], true);
      clear_depth(layer_targets_[at]);
      gl_.BindTextureUnit(0, depth_);
      gl_.BindTextureUnit(1, before);
      gl_.BeginQuery(GL_ANY_SAMPLES_PASSED, layer_query_);
      draw(film_program_, volume_);
      gl_.EndQuery(GL_ANY_SAMPLES_PASSED);
      settle();
      GLuint is_any = 0;
      gl_.GetQueryObjectuiv(layer_query_, GL_QUERY_RESULT, &is_any);
      if (is_any == 0) break;
      before = layer_depths_[at];

      begin(film_target_, false);
      blend(GL_ONE_MINUS_DST_ALPHA, GL_ONE);  // under what is there
      gl_.BindTextureUnit(0, layer_);
      gl_.BindTextureUnit(1, before);
      fill(layer_program_);
    }
    begin(image_target_, false);
    blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_.BindTextureUnit(0, film_);
    fill(copy_program_);
  }

  /// All of the volume that is behind the layer `before`.
  void rest(GLuint before) {
    begin(rest_target_, false);
    const std::array<GLfloat, 4> nothing = {0, 0, 0, 1};
    gl_.ClearNamedFramebufferfv(rest_target_, GL_COLOR, 0, nothing.data());
    gl_.BindTextureUnit(0, depth_);
    gl_.BindTextureUnit(1, before);
    gl_.Enable(GL_BLEND);
    gl_.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    draw(rest_program_, volume_);

    begin(film_target_, false);
    blend(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    gl_.BindTextureUnit(0, rest_);
    fill(mean_program_);
  }

  void paint_frame(int frame) {
    const auto report = [&](double part) { progress_.report((frame + part) / kFrames); };
    set_frame(frame);
    shadows();
    report(0.3);
    scene();
    report(0.5);
    films();
    report(0.9);

    begin(image_target_, false);
    blend(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_.BindTextureUnit(0, depth_);
    gl_.BindTextureUnit(1, layer_depths_[0]);
    gl_.ProgramUniform1f(line_program_, fades_, 0);
    draw(line_program_, creases_);
    draw(target_program_, target_);
    draw(line_program_, lines_);

    begin(sum_target_, false);
    blend(GL_ONE, GL_ONE);
    gl_.BindTextureUnit(0, image_);
    fill(copy_program_);
  }

  std::vector<std::uint8_t> read() {
    const auto width = static_cast<std::size_t>(view_.width), height = static_cast<std::size_t>(view_.height);
    std::vector<float> sum(3 * width * height);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.GetTextureImage(sum_, 0, GL_RGB, GL_FLOAT, static_cast<GLsizei>(sum.size() * sizeof(float)), sum.data());
    context_.check("reading a picture back");
    std::vector<std::uint8_t> bytes(sum.size());
    for (std::size_t row = 0; row < height; ++row) {
      progress_.check();
      const float* from = sum.data() + 3 * width * (height - 1 - row);
      for (std::size_t i = 0; i < 3 * width; ++i) {
        bytes[3 * width * row + i] =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(from[i] / kFrames, 0.0F, 1.0F)));
      }
    }
    return bytes;
  }

  const depth::GlContext& context_;
  const depth::GlFunctions& gl_;
  const DrawList& list_;
  const View& view_;
  const core::ProgressReporter& progress_;
  depth::GlObjects objects_;
  GLuint solid_program_ = 0, shadow_program_ = 0, shade_program_ = 0, film_program_ = 0, copy_program_ = 0,
         layer_program_ = 0, rest_program_ = 0, mean_program_ = 0, target_program_ = 0, line_program_ = 0;
  GLint which_ = -1, fades_ = -1;
  GLuint depth_ = 0, normal_ = 0, albedo_ = 0, image_ = 0, layer_ = 0, film_ = 0, rest_ = 0, sum_ = 0,
         nothing_before_ = 0;
  std::array<GLuint, 3> layer_depths_{}, layer_targets_{};
  GLuint sky_maps_ = 0, sun_maps_ = 0;
  GLuint scene_target_ = 0, image_target_ = 0, film_target_ = 0, rest_target_ = 0, sum_target_ = 0, shadow_target_ = 0;
  Batch solids_, skylit_, volume_, target_, ground_lines_, creases_, lines_;
  int layers_ = kMostLayers;
  GLuint screen_ = 0, frame_block_ = 0, layer_query_ = 0;
  core::Stopwatch queued_;  ///< since all was drawn
};

}  // namespace

std::vector<std::uint8_t> draw_picture(const depth::GlContext& context, const DrawList& list, const View& view,
                                       const core::ProgressReporter& progress) {
  const depth::GlCurrent current(context);
  return Painter(context, list, view, progress).paint();
}

}  // namespace vantage::internal::picture
