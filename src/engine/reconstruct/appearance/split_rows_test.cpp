// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_rows.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "core/math/color.h"
#include "engine/reconstruct/appearance/test_drawn.h"

namespace cei3d {
namespace {

const Drawn& body() {
  static const Drawn drawn = draw({0.3f, 0.5f, 0});
  return drawn;
}

std::vector<SplitRow> rows_of(const LinearSplitOptions& options) {
  const Drawn& d = body();
  return make_split_rows(*d.surface, d.samples(), options,
                         mean_colors(d.surface->mesh(), d.samples(), options));
}

LinearSplitOptions a_quarter(bool in_patches) {
  LinearSplitOptions o = small();
  o.max_hits = int(body().hits.size() / 4);
  o.in_patches = in_patches;
  return o;
}

// Whether a row was made of each hit.
std::vector<bool> kept_hits(const std::vector<SplitRow>& rows) {
  using Place = std::tuple<uint32_t, uint32_t, uint32_t, float, float>;
  std::set<Place> places;
  for (const SplitRow& r : rows)
    places.insert({r.vertices[0], r.vertices[1], r.vertices[2], r.barycentric[1], r.barycentric[2]});
  std::vector<bool> kept;
  for (const Hit& h : body().hits) {
    const auto& t = body().surface->mesh().triangles[h.triangle];
    kept.push_back(places.contains({t[0], t[1], t[2], h.b1, h.b2}));
  }
  return kept;
}

// The share of pairs of hits, closer to one another than a fifth of a patch, of which both were kept or none.
double shared_fate(const std::vector<bool>& kept) {
  const std::vector<Hit>& hits = body().hits;
  double pairs = 0, alike = 0;
  for (size_t i = 0; i < hits.size(); i += 10)
    for (size_t k = 0; k < hits.size(); ++k)
      if (k != i && length(hits[i].position - hits[k].position) < 0.01f) {
        ++pairs;
        alike += kept[i] == kept[k];
      }
  return alike / pairs;
}

TEST(SplitRows, ARandomSubsetIsOfPatchesWithAllTheirSamplesWhereThatIsAskedFor) {
  const std::vector<SplitRow> scattered = rows_of(a_quarter(false)), patches = rows_of(a_quarter(true));
  const double all = double(rows_of(small()).size());
  EXPECT_NEAR(double(scattered.size()) / all, 0.25, 0.02);
  EXPECT_NEAR(double(patches.size()) / all, 0.25, 0.06);
  EXPECT_NEAR(shared_fate(kept_hits(scattered)), 0.25 * 0.25 + 0.75 * 0.75, 0.05);
  EXPECT_GT(shared_fate(kept_hits(patches)), 0.85);
}

// Surface outside of the patches is not black.
TEST(SplitRows, MeanColorsAreOfAllSamples) {
  const Drawn& d = body();
  const auto share_of_black = [&](const LinearSplitOptions& options) {
    double black = 0;
    for (const Vec3f& c : pick(mean_colors(d.surface->mesh(), d.samples(), options), seen(d)))
      black += luminance(c) == 0;
    return black / double(seen(d).size());
  };
  EXPECT_EQ(share_of_black(a_quarter(true)), 0);
}

}  // namespace
}  // namespace cei3d
