// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/error.h"
#include "core/image/resample.h"
#include "core/math/quantile.h"
#include "engine/capture/doctor.h"
#include "engine/capture/normalize.h"

namespace cei3d {
namespace {

constexpr double kWrongPose = 0.3;   // share of doubtful pixels from which not the mask alone can be wrong
constexpr double kStandsOut = 0.02;  // share of the object that a mask has too much
constexpr double kAgree = 0.9;  // mean share of the object that all views agree on: cameras are not all wrong
constexpr size_t kTried = 24;   // views by which mistakes of all cameras are tried
constexpr int kTriedSize = 96;  // pixels

using Change = std::function<Camera(const Camera&)>;

// A mistake that concerns all cameras.
struct Mistake {
  std::string what;
  Change undo;
};

Mat3d flip_columns(const Mat3d& m) {
  Mat3d out = m;
  for (Vec3d& row : out.row) row = {row.x, -row.y, -row.z};
  return out;
}
Mat3d flip_rows(Mat3d m) {
  m.row[1] = -m.row[1], m.row[2] = -m.row[2];
  return m;
}

std::vector<Mistake> mistakes() {
  std::vector<Mistake> all;
  all.push_back(
      {"the y and z axes of the cameras point the other way (OpenGL's axes are not OpenCV's)", [](Camera c) {
         c.world_from_cam = flip_columns(c.world_from_cam);
         return c;
       }});
  all.push_back({"the poses are world-to-camera, not camera-to-world (or the reverse)", [](Camera c) {
                   const Mat3d r = c.world_from_cam;
                   c.world_from_cam = transpose(r);
                   c.center = -(transpose(r) * c.center);
                   return c;
                 }});
  all.push_back({"the poses are world-to-camera with OpenGL's axes", [](Camera c) {
                   const Mat3d r = flip_columns(c.world_from_cam);
                   c.world_from_cam = flip_columns(transpose(r));
                   c.center = -(transpose(r) * c.center);
                   return c;
                 }});
  all.push_back(
      {"the poses are world-to-camera with OpenCV's axes in a file that should have OpenGL's", [](Camera c) {
         const Mat3d r = flip_columns(c.world_from_cam);
         c.world_from_cam = transpose(r);
         c.center = -(transpose(r) * c.center);
         return c;
       }});
  all.push_back({"the y and z axes of the world point the other way for the rotations, not for the positions",
                 [](Camera c) {
                   c.world_from_cam = flip_rows(c.world_from_cam);
                   return c;
                 }});
  for (const double s : {0.25, 1 / 3.0, 0.5, 2 / 3.0, 0.8, 1.25, 1.5, 2.0, 3.0, 4.0})
    all.push_back({fmt::format("focal lengths are multiplied by {:.3g}", s), [s](Camera c) {
                     c.fx *= s, c.fy *= s;
                     return c;
                   }});
  return all;
}

struct Tried {
  std::vector<Camera> cameras;
  std::vector<std::vector<uint8_t>> masks;
};

// Some of the masks, small, with the cameras as the capture has them.
Tried some_masks(std::span<const JudgedMask> masks) {
  std::vector<HullMask> chosen;
  const size_t n = std::min(kTried, masks.size());
  for (size_t i = 0; i < n; ++i) {
    const JudgedMask& m = masks[i * masks.size() / n];
    chosen.push_back({m.view->camera, m.mask});
  }
  SmallMasks small = small_masks(chosen, Normalization(), kTriedSize);
  return {std::move(small.cameras), std::move(small.masks)};
}

// Mean share of the object that a consensus of the views confirms; 0: no volume in common.
double agreement(const Tried& tried, const Change& change) {
  std::vector<HullMask> views;
  for (size_t i = 0; i < tried.masks.size(); ++i) views.push_back({change(tried.cameras[i]), tried.masks[i]});
  try {
    const Normalization n = normalization_from_masks(views);
    double sum = 0;
    const std::vector<MaskDoubt> doubts = vote_on_masks(small_masks(views, n, kTriedSize));
    for (const MaskDoubt& d : doubts) sum += std::max(0.0, 1 - d.extra - d.missing);
    return sum / double(doubts.size());
  } catch (const Error&) {
    return 0;
  }
}

double overlap(const Area& a, const Area& b) {
  size_t both = 0, either = 0;
  for (size_t i = 0; i < a.size(); ++i) both += a[i] && b[i], either += a[i] || b[i];
  return double(both) / double(std::max<size_t>(either, 1));
}

Area mask_of(const std::vector<uint8_t>& mask) {
  Area out(mask.size());
  for (size_t i = 0; i < mask.size(); ++i) out[i] = mask[i] == kObject;
  return out;
}

// The mask enlarged about the middle of the image, or mirrored.
Area warped(const Area& mask, int width, int height, double scale, bool mirror) {
  Area out(mask.size(), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = ((mirror ? width - 1 - x : x) + 0.5 - width / 2.0) / scale + width / 2.0,
                   v = (y + 0.5 - height / 2.0) / scale + height / 2.0;
      if (u >= 0 && v >= 0 && u < width && v < height)
        out[size_t(y) * width + x] = mask[size_t(v) * size_t(width) + size_t(u)];
    }
  return out;
}

// The mask of a square image turned by quarters of a circle.
Area turned_mask(const Area& mask, int size, int quarters) {
  Area out = mask;
  for (int q = 0; q < quarters; ++q) {
    const Area from = out;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) out[size_t(y) * size + x] = from[size_t(size - 1 - x) * size + y];
  }
  return out;
}

// Mean and standard deviation of colors.
struct Colors {
  Vec3d mean{0, 0, 0}, deviation{0, 0, 0};
};

Colors colors_of(const Image& photograph, const std::vector<uint8_t>& mask, uint8_t kind,
                 const Area& doubtful) {
  Colors c;
  Vec3d squares{0, 0, 0};
  double n = 0;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != kind || doubtful[i]) continue;
    for (int k = 0; k < 3; ++k) {
      const double v = photograph.data[3 * i + size_t(k)];
      c.mean[k] += v, squares[k] += v * v;
    }
    ++n;
  }
  for (int k = 0; k < 3; ++k) {
    c.mean[k] /= std::max(n, 1.0);
    c.deviation[k] = std::sqrt(std::max(0.0, squares[k] / std::max(n, 1.0) - c.mean[k] * c.mean[k]));
  }
  return c;
}

// Squared distance in standard deviations, which are 0.02 at least.
double distance_to(const Colors& colors, const float* color) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += square((color[k] - colors.mean[k]) / (colors.deviation[k] + 0.02));
  return sum;
}

// Whether the photograph shows the background where the mask has background and the other views have the
// object: most colors there are nearer to those of the background than to those of the object.
bool shows_background(const Image& photograph, const std::vector<uint8_t>& mask, const MaskDoubt& doubt) {
  const Colors background = colors_of(photograph, mask, kBackground, doubt.doubtful),
               object = colors_of(photograph, mask, kObject, doubt.doubtful);
  size_t alike = 0, all = 0;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (!doubt.missing_area[i]) continue;
    alike += distance_to(background, &photograph.data[3 * i]) < distance_to(object, &photograph.data[3 * i]);
    ++all;
  }
  return 2 * alike > all;
}

// The photograph at the size of the small mask: the mask may be reduced more.
Image of_mask_size(const Image& photograph, const MaskDoubt& doubt) {
  const bool same = photograph.width == doubt.width && photograph.height == doubt.height;
  return same ? photograph : scaled_to(photograph, doubt.width, doubt.height);
}

// Drops the votes that the photographs contradict. A view with an explanation is wrong as a whole, so its
// photograph does not count.
void drop_contradicted_votes(std::span<const JudgedMask> masks, const SmallMasks& small,
                             const std::vector<std::string>& explanations, std::vector<MaskDoubt>& doubts) {
  for (size_t i = 0; i < doubts.size(); ++i) {
    const Image* photograph = masks[i].photograph;
    MaskDoubt& d = doubts[i];
    if (!d.stands_out || !explanations[i].empty() || !photograph || photograph->empty()) continue;
    if (pixels_in(d.missing_area) == 0 || !shows_background(of_mask_size(*photograph, d), small.masks[i], d))
      continue;
    for (size_t k = 0; k < d.doubtful.size(); ++k) d.doubtful[k] = d.doubtful[k] && !d.missing_area[k];
    d.missing = 0;
    d.stands_out = d.extra > kStandsOut;
  }
}

struct Suspect {
  const JudgedMask* mask;
  const MaskDoubt* doubt;
  std::string why;  // explanation()
};

struct Explanation {
  std::string text;              // empty: none
  std::optional<size_t> camera;  // of the view whose camera would fit
};

// What would make the suspect fit: its image mirrored, turned, of another camera, or of another size; else
// nothing is known.
Explanation explanation(size_t suspect, const Area& object, std::span<const JudgedMask> masks,
                        const std::vector<MaskDoubt>& doubts) {
  const MaskDoubt& doubt = doubts[suspect];
  const int w = doubt.width, h = doubt.height;
  const double now = overlap(object, doubt.consensus);
  double best = std::max(0.75, now + 0.1);
  Explanation found;
  const auto take = [&](double fit, const std::string& words, std::optional<size_t> camera) {
    if (fit > best) best = fit, found = {words, camera};
  };
  for (size_t i = 0; i < masks.size(); ++i)
    if (i != suspect && doubts[i].width == w && doubts[i].height == h)
      take(overlap(object, doubts[i].consensus), fmt::format("fits the camera of {}", masks[i].view->name),
           i);
  take(overlap(warped(object, w, h, 1, true), doubt.consensus) - 0.02, "fits if its image is mirrored", {});
  for (const double scale : {0.5, 2 / 3.0, 0.8, 1.25, 1.5, 2.0})
    take(overlap(warped(object, w, h, scale, false), doubt.consensus) - 0.02,
         fmt::format("fits if its image is scaled by {:.2g}", scale), {});
  for (int quarters = 1; w == h && quarters < 4; ++quarters)
    take(overlap(turned_mask(object, w, quarters), doubt.consensus) - 0.02,
         fmt::format("fits if its image is turned by {} degrees", 90 * quarters), {});
  return found;
}

// What explains each view that stands out. Where the image of one belongs to the camera of another, that
// one's image is wrong, too.
std::vector<std::string> explanations_of(std::span<const JudgedMask> masks, const SmallMasks& small,
                                         const std::vector<MaskDoubt>& doubts) {
  std::vector<Explanation> found(doubts.size());
  for (size_t i = 0; i < doubts.size(); ++i)
    if (doubts[i].stands_out) found[i] = explanation(i, mask_of(small.masks[i]), masks, doubts);
  std::vector<std::string> out;
  for (const Explanation& e : found) out.push_back(e.text);
  for (size_t i = 0; i < doubts.size(); ++i)
    if (const auto k = found[i].camera; k && doubts[*k].stands_out && out[*k].empty())
      out[*k] = fmt::format("the image of {} fits its camera", masks[i].view->name);
  return out;
}

std::vector<std::string> names_of(const std::vector<Suspect>& all) {
  std::vector<std::string> names;
  for (const Suspect& s : all) names.push_back(s.mask->view->name);
  return names;
}

void report_poses(const std::vector<Suspect>& poses, size_t all, std::vector<Finding>& findings) {
  if (poses.empty()) return;
  std::vector<std::string> texts;
  for (const Suspect& s : poses)
    texts.push_back(s.mask->view->name + (s.why.empty() ? "" : " (" + s.why + ")"));
  findings.push_back(
      {Severity::warning,
       fmt::format("{} of {} views do not fit the others: {}.", poses.size(), all, some_names(texts)),
       "Their poses or images are wrong: exchange the images, match the photographs again, or remove "
       "these views.",
       names_of(poses), removal_of(names_of(poses))});
}

void report_masks(const std::vector<Suspect>& wrong, size_t all, const char* what,
                  std::vector<Finding>& findings) {
  if (wrong.empty()) return;
  findings.push_back(
      {Severity::warning,
       fmt::format("{} of {} masks {}: {}.", wrong.size(), all, what, some_names(names_of(wrong))),
       "Correct these masks. Where they contradict the other views, `reconstruct` does not use them.",
       names_of(wrong)});
}

// Mistakes of all cameras, when the masks do not agree as they are. Whether one was found.
bool report_mistake(std::span<const JudgedMask> masks, std::vector<Finding>& findings) {
  const Tried tried = some_masks(masks);
  const double now = agreement(tried, [](const Camera& c) { return c; });
  if (now > kAgree) return false;
  const std::vector<Mistake> all = mistakes();
  const Mistake* best = nullptr;
  double largest = std::max(kAgree, now + 0.1);
  for (const Mistake& m : all)
    if (const double a = agreement(tried, m.undo); a > largest) largest = a, best = &m;
  if (!best) return false;
  findings.push_back(
      {Severity::error,
       fmt::format("Masks and cameras disagree ({:.0f} % of the object is confirmed by the other views). "
                   "They agree ({:.0f} %) if {}.",
                   100 * now, 100 * largest, best->what),
       "Correct the cameras; `check` can write a corrected copy of the capture.",
       {},
       [undo = best->undo](Capture& c) {
         for (View& v : c.views) {
           v.camera = undo(v.camera);
           if (v.photo) v.photo = PhotoCamera(undo(v.photo->camera()), v.photo->lens());
         }
       }});
  return true;
}

}  // namespace

std::vector<Area> check_silhouettes(std::span<const JudgedMask> masks,
                                    const std::optional<Normalization>& normalization,
                                    std::vector<Finding>& findings) {
  if (masks.size() < 4) return {};
  std::vector<HullMask> hull;
  for (const JudgedMask& m : masks) hull.push_back({m.view->camera, m.mask});
  if (!normalization) {
    report_mistake(masks, findings);
    return {};
  }
  const SmallMasks small = small_masks(hull, *normalization);
  std::vector<MaskDoubt> doubts = vote_on_masks(small);
  const std::vector<std::string> explanations = explanations_of(masks, small, doubts);
  drop_contradicted_votes(masks, small, explanations, doubts);
  std::vector<double> unconfirmed;
  for (const MaskDoubt& d : doubts) unconfirmed.push_back(d.extra + d.missing);
  if (median(unconfirmed) > 1 - kAgree && report_mistake(masks, findings)) return {};
  std::vector<Suspect> poses, missing, extra;
  std::vector<Area> areas(masks.size());
  for (size_t i = 0; i < doubts.size(); ++i) {
    if (!doubts[i].stands_out) continue;
    const Suspect s{&masks[i], &doubts[i], explanations[i]};
    const bool pose = !s.why.empty() || doubts[i].extra > kWrongPose ||
                      (doubts[i].missing > 0.05 && doubts[i].extra > 0.05);
    (pose ? poses : doubts[i].missing > doubts[i].extra ? missing : extra).push_back(s);
    const Camera& camera = masks[i].view->camera;
    areas[i] = enlarged(doubts[i].doubtful, doubts[i].width, doubts[i].height, camera.width, camera.height);
  }
  report_poses(poses, masks.size(), findings);
  report_masks(missing, masks.size(), "leave out parts of the object that the other views show", findings);
  report_masks(extra, masks.size(), "include what no other view takes for the object", findings);
  return areas;
}

}  // namespace cei3d
