// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/residual_images_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/cancel.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/math/psnr.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/photo_blocks.h"
#include "engine/reconstruct/appearance/shaded_samples.h"
#include "engine/reconstruct/edge_pixels.h"
#include "engine/render/render.h"

namespace cei3d {

namespace {

constexpr size_t kSlab = 1 << 13;   // pixels traced at a time: tracing takes more memory than the hits do
constexpr size_t kJudged = 200000;  // pixels that the strengths are found by, about
constexpr size_t kFewest = 300;     // of them for the strength of an angle
constexpr double kMinGain = 0.03;   // of the squared error
constexpr int kStrengthSteps = 20;  // strengths that are tried, from 0 to 1
// Share of the photographs that there should be time for; if there is, the rest is rather left out than all
// made from larger blocks.
constexpr double kEnough = 0.4;

// What is known of a pixel that the images are judged by. Linear.
struct Judged {
  Hit hit;
  int image;  // of its own view
  Vec3f radiance, photo;
};

// Blocks of one view whose rays meet the surface.
struct ViewHits {
  std::vector<Hit> hits;
  std::vector<size_t> block;  // #hits
  std::vector<float> footprints;
};

// What all views need to be made into images.
struct Making {
  const Device& device;
  const Scene& scene;
  const PixelStore& store;
  const LightTurns* turns;
  const ResidualImagesOptions& options;
  const Progress& progress;
  SampleShader shader;
};

class ImagesFit {
 public:
  ImagesFit(const Making& making, const PhotoBlocks& photos)
      : m_(making), photos_(photos), share_(double(kJudged) / double(std::max<size_t>(photos.count(), 1))) {}

  // index: that the image will have.
  ResidualImage image_of(uint16_t view, int index) {
    const Camera& camera = photos_.cameras()[view];
    const std::vector<PhotoBlocks::Block> blocks = photos_.of_view(view);
    const ViewHits seen = trace(view, blocks);
    const std::vector<uint16_t> views(seen.hits.size(), view);
    const std::vector<Vec3f> radiance =
        m_.shader.radiance({seen.hits, {}, {}, seen.footprints, {m_.turns, views}}, m_.progress);
    std::vector<std::array<uint16_t, 2>> places;
    std::vector<Vec3f> differences;
    std::vector<float> distances;
    for (size_t i = 0; i < seen.hits.size(); ++i) {
      const PhotoBlocks::Block& block = blocks[seen.block[i]];
      places.push_back({block.x, block.y});
      differences.push_back(difference(block, radiance[i]));
      distances.push_back(length(seen.hits[i].position - to_float(camera.center)));
      if (Rng(m_.options.seed, view, seen.block[i]).uniform() < share_)
        judged_.push_back({seen.hits[i], index, radiance[i], block.color});
    }
    return ResidualImage(camera, places, differences, distances);
  }

  const std::vector<Judged>& judged() const { return judged_; }

 private:
  using Blocks = std::span<const PhotoBlocks::Block>;

  ViewHits trace(uint16_t view, Blocks blocks) const {
    ViewHits out;
    for (size_t begin = 0; begin < blocks.size(); begin += kSlab) {
      check_cancelled(m_.progress);
      add_hits(view, blocks.subspan(begin, std::min(kSlab, blocks.size() - begin)), begin, out);
    }
    return out;
  }

  // Without blocks at edges, whose color is of two surfaces. first: index of the first of these blocks.
  void add_hits(uint16_t view, Blocks blocks, size_t first, ViewHits& out) const {
    const Camera& camera = photos_.cameras()[view];
    std::vector<Ray> rays;
    for (const PhotoBlocks::Block& b : blocks) rays.push_back(camera.ray(b.x + 0.5, b.y + 0.5));
    std::vector<uint32_t> ray_of_hit;
    const std::vector<Hit> hits = trace_rays(m_.device, *m_.scene.sdf, *m_.scene.surface, rays, ray_of_hit);
    std::vector<SeenAt> seen;
    for (const uint32_t ray : ray_of_hit) seen.push_back({view, blocks[ray].x, blocks[ray].y});
    const std::vector<uint8_t> edge = on_edges(*m_.scene.surface, photos_.cameras(), hits, seen);
    for (size_t i = 0; i < hits.size(); ++i) {
      if (edge[i]) continue;
      out.hits.push_back(hits[i]);
      out.block.push_back(first + ray_of_hit[i]);
      out.footprints.push_back(length(hits[i].position - to_float(camera.center)) / float(camera.fx));
    }
  }

  // A clipped channel of a photograph says nothing of a brighter object.
  static Vec3f difference(const PhotoBlocks::Block& block, Vec3f radiance) {
    Vec3f d = block.color - radiance;
    for (int c = 0; c < 3; ++c)
      if (block.clipped >> c & 1) d[c] = std::max(d[c], 0.0f);
    return d;
  }

  const Making& m_;
  const PhotoBlocks& photos_;
  double share_;  // of the blocks that are judged
  std::vector<Judged> judged_;
};

struct Made {
  std::vector<ResidualImage> images;
  std::vector<Judged> judged;
};

// Side of a block in pixels, so that enough images are made in `seconds` if they take as long as the first.
int affordable_size(const Making& m, double seconds) {
  const int size = PhotoBlocks::size_for(m.store, m.options.max_pixels);
  if (m.options.seconds <= 0) return size;
  const double begin = m.options.clock();
  const PhotoBlocks photos(m.store, size);
  ImagesFit(m, photos).image_of(0, 0);
  const double took = (m.options.clock() - begin) * double(photos.cameras().size()),
               larger = std::ceil(std::sqrt(kEnough * took / std::max(seconds, 1e-3)));
  return int(std::clamp(size * larger, double(size), double(PhotoBlocks::kLargest)));
}

// Neighbors in the capture are far from each other, so that where time is over, views from all around are
// done.
std::vector<uint16_t> spread_order(size_t views) {
  size_t step = std::max<size_t>(1, size_t(0.618 * double(views)));
  while (std::gcd(step, views) != 1) ++step;
  std::vector<uint16_t> out;
  for (size_t k = 0; k < views; ++k) out.push_back(uint16_t(k * step % views));
  return out;
}

Made make_images(const Device& device, const Scene& scene, const PixelStore& store, const LightTurns* turns,
                 const ResidualImagesOptions& options, Progress& progress) {
  const double start = options.clock();
  const Making m{
      device, scene, store, turns, options, progress, SampleShader(device, scene, turns, progress)};
  const PhotoBlocks photos(store, affordable_size(m, options.seconds - (options.clock() - start)));
  ImagesFit fit(m, photos);
  Made out;
  for (const uint16_t view : spread_order(store.cameras().size())) {
    const double past = options.clock() - start;
    if (options.seconds > 0 && past > options.seconds && !out.images.empty()) break;
    progress.report({"residual", double(out.images.size()) / double(store.cameras().size()), -1, ""});
    out.images.push_back(fit.image_of(view, int(out.images.size())));
  }
  out.judged = fit.judged();
  return out;
}

using Blends = std::vector<std::optional<ResidualImages::Blend>>;

Blends blends_of_others(const ResidualImages& images, const std::vector<Judged>& judged) {
  Blends out(judged.size());
  parallel_ranges(int(judged.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      out[size_t(i)] = images.blend(judged[size_t(i)].hit, judged[size_t(i)].image);
  });
  return out;
}

// The share of the blends that leaves the smallest error.
float best_share(const std::vector<Judged>& judged, const Blends& blends, std::span<const size_t> which) {
  float best = 0;
  double least = -1;
  for (int k = 0; k <= kStrengthSteps; ++k) {
    const float share = float(k) / kStrengthSteps;
    double error = 0;
    for (const size_t i : which)
      error += display_error(judged[i].radiance + share * blends[i]->difference, judged[i].photo);
    if (least < 0 || error < least) least = error, best = share;
  }
  return best;
}

// Of each angle by the pixels whose blends are nearest to it; where there are few, the strength of the next
// larger angle.
ResidualImages::Strengths strengths_of(const std::vector<Judged>& judged, const Blends& blends) {
  std::array<std::vector<size_t>, ResidualImages::kAngles.size()> near;
  for (size_t i = 0; i < judged.size(); ++i)
    if (blends[i]) near[ResidualImages::nearest_angle(blends[i]->angle)].push_back(i);
  ResidualImages::Strengths out{};
  for (size_t k = near.size(); k-- > 0;)
    out[k] = near[k].size() >= kFewest ? best_share(judged, blends, near[k])
             : k + 1 < near.size()     ? out[k + 1]
                                       : 0;
  return out;
}

}  // namespace

ResidualImagesFit fit_residual_images(const Device& device, const Scene& scene, const PixelStore& store,
                                      const LightTurns* turns, const ResidualImagesOptions& options,
                                      Progress& progress) {
  progress.report({"residual", 0, -1, ""});
  Made made = make_images(device, scene, store, turns, options, progress);
  ResidualImages images(std::move(made.images));
  const Blends blends = blends_of_others(images, made.judged);
  images.set_strengths(strengths_of(made.judged, blends));
  double without = 1e-12, with = 1e-12;
  for (size_t i = 0; i < made.judged.size(); ++i) {
    const Judged& j = made.judged[i];
    const Vec3f add = blends[i] ? images.strength(blends[i]->angle) * blends[i]->difference : Vec3f{0, 0, 0};
    without += display_error(j.radiance, j.photo);
    with += display_error(j.radiance + add, j.photo);
  }
  const auto psnr = [n = 3 * double(std::max<size_t>(made.judged.size(), 1))](double sum) {
    return psnr_of_mse(sum / n);
  };
  const Explained explained{psnr(without), psnr(with)};
  progress.log(Json{{"stage", "residual"},
                    {"strengths", images.strengths()},
                    {"physical", explained.physical},
                    {"with_residual", explained.with_residual}}
                   .dump());
  check_cancelled(progress);
  if (with > (1 - kMinGain) * without) return {nullptr, {explained.physical, explained.physical}};
  images.sharpen();
  return {std::make_shared<const ResidualImages>(std::move(images)), explained};
}

}  // namespace cei3d
