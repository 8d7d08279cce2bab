// SPDX-License-Identifier: Apache-2.0
#include "model/scene/residual_images.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/math/quantile.h"
#include "model/geometry/shape/camera_json.h"

namespace cei3d {

namespace {

constexpr float kReach = 1;               // the object is within the unit sphere
constexpr float kDistanceSteps = 65534;   // a distance is 1 to 65535; 0: the pixel shows nothing
constexpr int kZero = 128, kSteps = 127;  // byte of no difference, and the steps on either side of it
// Larger differences than those of all but this share of the channels are cut off: a few of sharp highlights
// would leave coarse steps for all others.
constexpr double kCutOff = 1e-3;
constexpr float kGrazing = 0.15f;  // cosine between normal and direction to the camera, at least
// Distance of a neighboring pixel's surface from the tangent plane of the point, at most, in pixels on the
// surface.
constexpr float kSameSurface = 2;
constexpr float kMinShown = 0.5f;  // share of the interpolation weights that show the surface, at least

constexpr float kDetail = 0.06f;  // side of the squares over which details are averaged, unit frame

constexpr size_t kBlended = 4;  // pictures
constexpr size_t kTried = 12;  // pictures from the nearest directions that may turn out not to show the point
constexpr float kDegree = std::numbers::pi_v<float> / 180;
constexpr float kNoAngle = 0.3f * kDegree;  // smaller angles count alike

// |v| = range (steps / kSteps)^2.
uint8_t byte_of(float v, float range) {
  const float steps = range > 0 ? kSteps * std::sqrt(std::min(std::abs(v) / range, 1.0f)) : 0;
  return uint8_t(kZero + int(std::copysign(std::lround(steps), v)));
}

float value_of(uint8_t byte, float range) {
  const float q = float(int(byte) - kZero) / kSteps;
  return range * q * std::abs(q);
}

float range_of(std::span<const Vec3f> differences) {
  std::vector<float> sizes;
  for (const Vec3f& d : differences)
    for (int c = 0; c < 3; ++c) sizes.push_back(std::abs(d[c]));
  return sizes.empty() ? 0 : quantile(std::move(sizes), 1 - kCutOff);
}

float nearest_of(const Camera& camera) { return std::max(0.0f, float(length(camera.center)) - kReach); }

// The camera of the smallest window that holds the pixels; first: its first column and row.
Camera window_of(Camera camera, std::span<const std::array<uint16_t, 2>> pixels, std::array<int, 2>& first) {
  std::array<int, 2> low{camera.width, camera.height}, high{0, 0};
  for (const auto& p : pixels)
    for (size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], int(p[k]));
      high[k] = std::max(high[k], int(p[k]) + 1);
    }
  first = low;
  camera.width = std::max(0, high[0] - low[0]);
  camera.height = std::max(0, high[1] - low[1]);
  camera.cx -= low[0];
  camera.cy -= low[1];
  return camera;
}

using Places = std::vector<std::array<uint16_t, 2>>;

// A pixel of a render is a mean over a tent two pixels wide, and between pixels an image is interpolated,
// which is another such mean: together a cubic B-spline.
class Spline {
 public:
  Spline(int width, int height, const Places& places)
      : width_(width), height_(height), at_(size_t(width) * size_t(height), -1), places_(places) {
    for (size_t i = 0; i < places.size(); ++i) at_[index(places[i][0], places[i][1])] = int(i);
  }

  // Mean around each of the places, over those that have values.
  std::vector<Vec3f> means(const std::vector<Vec3f>& values) const {
    std::vector<Vec3f> out;
    for (const auto& place : places_) {
      Vec3f sum{0, 0, 0};
      float total = 0;
      for (int k = 0; k < 9; ++k) {
        const int near = at(place[0] + k % 3 - 1, place[1] + k / 3 - 1);
        if (near < 0) continue;
        const float weight = kWeights[size_t(k % 3)] * kWeights[size_t(k / 3)];
        sum += weight * values[size_t(near)];
        total += weight;
      }
      out.push_back(sum / total);
    }
    return out;
  }

 private:
  static constexpr std::array<float, 3> kWeights = {1.0f / 6, 4.0f / 6, 1.0f / 6};
  size_t index(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }
  int at(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_ ? at_[index(x, y)] : -1; }

  int width_, height_;
  std::vector<int> at_;  // by pixel, index of the place; -1: none
  const Places& places_;
};

}  // namespace

ResidualImage::ResidualImage(const Camera& camera, std::span<const std::array<uint16_t, 2>> pixels,
                             std::span<const Vec3f> differences, std::span<const float> distances)
    : range_(range_of(differences)), nearest_(nearest_of(camera)) {
  std::array<int, 2> first{};
  camera_ = window_of(camera, pixels, first);
  bytes_.assign(size_t(camera_.width) * size_t(camera_.height) * kBytes, 0);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const size_t x = size_t(pixels[i][0] - first[0]), y = size_t(pixels[i][1] - first[1]);
    uint8_t* out = &bytes_[(y * size_t(camera_.width) + x) * kBytes];
    for (int c = 0; c < 3; ++c) out[c] = byte_of(differences[i][c], range_);
    const float share = std::clamp((distances[i] - nearest_) / (2 * kReach), 0.0f, 1.0f);
    const auto steps = uint16_t(1 + std::lround(share * kDistanceSteps));
    out[3] = uint8_t(steps >> 8);
    out[4] = uint8_t(steps & 255);
  }
}

ResidualImage::ResidualImage(const Camera& camera, float range, std::vector<uint8_t> bytes)
    : camera_(camera), range_(range), nearest_(nearest_of(camera)), bytes_(std::move(bytes)) {}

std::optional<float> ResidualImage::distance(int x, int y) const {
  const uint8_t* p = pixel(x, y);
  const int steps = p[3] << 8 | p[4];
  if (steps == 0) return {};
  return nearest_ + 2 * kReach * float(steps - 1) / kDistanceSteps;
}

std::optional<Vec3f> ResidualImage::point_of(int x, int y) const {
  const std::optional<float> t = distance(x, y);
  if (!t) return {};
  const Ray ray = camera_.ray(x + 0.5, y + 0.5);
  return ray.origin + ray.direction * *t;
}

Vec3f ResidualImage::difference(int x, int y) const {
  const uint8_t* p = pixel(x, y);
  return {value_of(p[0], range_), value_of(p[1], range_), value_of(p[2], range_)};
}

std::optional<Vec3f> ResidualImage::at(Vec3f position, Vec3f normal) const {
  const Vec3f to_camera = to_float(camera_.center) - position;
  const float distance = length(to_camera);
  if (dot(normal, to_camera) < kGrazing * distance) return {};
  const Vec3d seen = camera_.project({position.x, position.y, position.z});
  if (!(seen.z > 0 && seen.x >= 0 && seen.y >= 0 && seen.x < camera_.width && seen.y < camera_.height))
    return {};
  const float u = float(seen.x) - 0.5f, v = float(seen.y) - 0.5f;
  const int x0 = int(std::floor(u)), y0 = int(std::floor(v));
  const float allowed = kSameSurface * distance / float(camera_.fx);
  Vec3f sum{0, 0, 0};
  float shown = 0;
  for (int k = 0; k < 4; ++k) {
    const int x = x0 + k % 2, y = y0 + k / 2;
    if (x < 0 || y < 0 || x >= camera_.width || y >= camera_.height) continue;
    const std::optional<Vec3f> point = point_of(x, y);
    if (!point || std::abs(dot(*point - position, normal)) > allowed) continue;
    const float weight =
        (k % 2 ? u - float(x0) : 1 - u + float(x0)) * (k / 2 ? v - float(y0) : 1 - v + float(y0));
    sum += weight * difference(x, y);
    shown += weight;
  }
  if (shown < kMinShown) return {};
  return sum / shown;
}

// By Van Cittert's iteration: what the means lack is added to the values.
ResidualImage ResidualImage::sharpened() const {
  constexpr int kIterations = 3;
  Places places;
  std::vector<Vec3f> wanted;
  std::vector<float> distances;
  for (int y = 0; y < camera_.height; ++y)
    for (int x = 0; x < camera_.width; ++x)
      if (const std::optional<float> t = distance(x, y)) {
        places.push_back({uint16_t(x), uint16_t(y)});
        wanted.push_back(difference(x, y));
        distances.push_back(*t);
      }
  const Spline spline(camera_.width, camera_.height, places);
  std::vector<Vec3f> values = wanted;
  for (int k = 0; k < kIterations; ++k) {
    const std::vector<Vec3f> means = spline.means(values);
    for (size_t i = 0; i < values.size(); ++i) values[i] += wanted[i] - means[i];
  }
  return ResidualImage(camera_, places, values, distances);
}

ResidualImage ResidualImage::smoothed(float size) const {
  const double pixels = size * camera_.fx / std::max(length(camera_.center), 1e-6);
  const int n = std::clamp(int(std::lround(pixels)), 1, std::max(1, std::max(camera_.width, camera_.height)));
  Camera small = scaled(camera_, n);
  small.width = (camera_.width + n - 1) / n, small.height = (camera_.height + n - 1) / n;
  Places places;
  std::vector<Vec3f> differences;
  std::vector<float> distances;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      Vec3f sum{0, 0, 0};
      float far = 0, shown = 0;
      for (int v = y * n; v < std::min((y + 1) * n, camera_.height); ++v)
        for (int u = x * n; u < std::min((x + 1) * n, camera_.width); ++u)
          if (const std::optional<float> t = distance(u, v)) sum += difference(u, v), far += *t, ++shown;
      if (shown == 0) continue;
      places.push_back({uint16_t(x), uint16_t(y)});
      differences.push_back(sum / shown);
      distances.push_back(far / shown);
    }
  return ResidualImage(small, places, differences, distances);
}

ResidualImages::ResidualImages(std::vector<ResidualImage> images) : images_(std::move(images)) {
  strengths_.fill(1);
  smooth_.resize(images_.size());
  parallel_for(int(images_.size()),
               [&](int i) { smooth_[size_t(i)] = images_[size_t(i)].smoothed(kDetail); });
}

void ResidualImages::sharpen() {
  parallel_for(int(images_.size()), [&](int i) { images_[size_t(i)] = images_[size_t(i)].sharpened(); });
}

size_t ResidualImages::nearest_angle(float angle) {
  size_t k = 0;
  while (k + 1 < kAngles.size() && angle / kDegree > 0.5f * (kAngles[k] + kAngles[k + 1])) ++k;
  return k;
}

namespace {

// A picture's weight falls to zero where the next best one has its angle, so that the blend does not jump
// where another picture comes in.
std::optional<ResidualImages::Blend> blend_of(std::span<const ResidualImage> images, const Hit& hit,
                                              int without = -1) {
  using Blend = ResidualImages::Blend;
  const float farthest = ResidualImages::kAngles.back() * kDegree;
  std::vector<std::pair<float, size_t>> near;  // minus cosine, picture
  for (size_t i = 0; i < images.size(); ++i) {
    if (int(i) == without) continue;
    const Vec3f to_camera = normalize(to_float(images[i].camera().center) - hit.position);
    const float cosine = dot(to_camera, hit.to_camera);
    if (cosine > std::cos(farthest)) near.push_back({-cosine, i});
  }
  const size_t tried = std::min(kTried, near.size());
  std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(tried), near.end());
  std::vector<std::pair<float, Vec3f>> shown;  // angle, difference
  for (size_t k = 0; k < tried && shown.size() <= kBlended; ++k)
    if (const std::optional<Vec3f> d = images[near[k].second].at(hit.position, hit.normal))
      shown.push_back({std::acos(std::min(-near[k].first, 1.0f)), *d});
  if (shown.empty()) return {};
  const float none = shown.size() > kBlended ? std::max(shown.back().first, kNoAngle) : farthest;
  shown.resize(std::min(shown.size(), kBlended));
  Blend out{{0, 0, 0}, 0};
  float total = 0;
  for (const auto& [angle, difference] : shown) {
    const float weight = std::max(1 - angle / none, 1e-4f) / (angle + kNoAngle);
    out.difference += weight * difference;
    out.angle += weight * angle;
    total += weight;
  }
  return Blend{out.difference / total, out.angle / total};
}

}  // namespace

std::optional<ResidualImages::Blend> ResidualImages::blend(const Hit& hit, int without) const {
  return blend_of(images_, hit, without);
}

float ResidualImages::strength(float angle) const {
  const float degrees = angle / kDegree;
  for (size_t k = 1; k < kAngles.size(); ++k)
    if (degrees <= kAngles[k]) {
      const float t = (degrees - kAngles[k - 1]) / (kAngles[k] - kAngles[k - 1]);
      return (1 - t) * strengths_[k - 1] + t * strengths_[k];
    }
  return strengths_.back();
}

Vec3f ResidualImages::weighed(const std::optional<Blend>& b) const {
  return b ? strength(b->angle) * b->difference : Vec3f{0, 0, 0};
}
Vec3f ResidualImages::at(const Hit& hit) const { return weighed(blend(hit)); }
Vec3f ResidualImages::smooth_at(const Hit& hit) const { return weighed(blend_of(smooth_, hit)); }

void save_residual_images(const ResidualImages& images, Tensors& tensors, Json& head) {
  Json list = Json::array();
  for (size_t i = 0; i < images.images().size(); ++i) {
    const ResidualImage& image = images.images()[i];
    Json camera = camera_json(image.camera());
    list.push_back({{"camera", std::move(camera)}, {"range", image.range()}});
    tensors[fmt::format("residual_images/{}", i)] = {
        {image.camera().height, image.camera().width, int64_t(ResidualImage::kBytes)}, {}, image.bytes()};
  }
  head["residual_images"] = {{"images", std::move(list)}, {"strengths", images.strengths()}};
}

ResidualImages load_residual_images(const Tensors& tensors, JsonReader head) {
  std::vector<ResidualImage> images;
  for (const Json& j : head.member("images")) {
    JsonReader reader(j, head.what() + ": an image");
    JsonReader camera_reader = reader.object("camera");
    const Camera camera = camera_from_json(camera_reader);
    camera_reader.finish();
    const auto range = reader.require<float>("range");
    reader.finish();
    const std::string name = fmt::format("residual_images/{}", images.size());
    images.emplace_back(
        camera, range,
        require_bytes(tensors, name, {camera.height, camera.width, int64_t(ResidualImage::kBytes)}).u8);
  }
  ResidualImages::Strengths strengths;
  const auto values = head.numbers<ResidualImages::kAngles.size()>("strengths");
  for (size_t k = 0; k < values.size(); ++k) strengths[k] = float(values[k]);
  head.finish();
  ResidualImages out(std::move(images));
  out.set_strengths(strengths);
  return out;
}

}  // namespace cei3d
