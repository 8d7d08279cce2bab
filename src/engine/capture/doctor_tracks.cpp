// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/error.h"
#include "core/math/quantile.h"
#include "engine/capture/doctor.h"

namespace cei3d {
namespace {

constexpr size_t kMinSightings = 8;  // minimum number of sightings of a view that is judged
// Maximum median error of cameras that fit their points: pixels in images of 1000 pixels.
constexpr double kMaxMedianError = 1.0;
// Maximum error that the right reading of the cameras leaves, as a share of that of the present one.
constexpr double kMaxExplainedShare = 0.5;
// A view stands out if its error is larger than this many times the median over views.
constexpr double kOutlierFactor = 5;

PhotoCamera camera_of(const View& view) {
  return view.photo ? *view.photo : PhotoCamera(view.camera, LensDistortion());
}

std::vector<Vec2d> residuals(const View& view, const PhotoCamera& camera) {
  std::vector<Vec2d> out;
  const Camera& c = camera.camera();
  for (const Sighting& s : *view.sightings) {
    const auto p = project(camera, s.point);
    out.push_back(p ? *p - s.pixel : Vec2d{double(c.width), double(c.height)});
  }
  return out;
}

double median_length(const std::vector<Vec2d>& residuals) {
  std::vector<double> lengths;
  for (const Vec2d r : residuals) lengths.push_back(std::hypot(r.x, r.y));
  return median(lengths);
}

// Another way to read the numbers of a camera.
struct Reading {
  std::string what;  // completes "The cameras fit their sparse points if ..."
  std::function<PhotoCamera(const PhotoCamera&)> change;
};

Camera moved(Camera c, double dx, double dy) {
  c.cx += dx, c.cy += dy;
  return c;
}
Camera enlarged(Camera c, double s) {
  for (double* k : {&c.fx, &c.fy, &c.cx, &c.cy, &c.skew}) *k *= s;
  return c;
}

std::vector<Reading> readings() {
  std::vector<Reading> all;
  all.push_back({"p1 and p2 are exchanged", [](const PhotoCamera& p) {
                   LensDistortion lens = p.lens();
                   std::swap(lens.p1, lens.p2);
                   return PhotoCamera(p.camera(), lens);
                 }});
  all.push_back({"the last coefficients are k3, k4 and not p1, p2", [](const PhotoCamera& p) {
                   LensDistortion lens = p.lens();
                   lens.radial[2] = lens.p1, lens.radial[3] = lens.p2, lens.p1 = lens.p2 = 0;
                   return PhotoCamera(p.camera(), lens);
                 }});
  all.push_back({"k3, k4 are p1, p2", [](const PhotoCamera& p) {
                   LensDistortion lens = p.lens();
                   lens.p1 = lens.radial[2], lens.p2 = lens.radial[3], lens.radial[2] = lens.radial[3] = 0;
                   return PhotoCamera(p.camera(), lens);
                 }});
  all.push_back({"the radial coefficients have the other sign", [](const PhotoCamera& p) {
                   LensDistortion lens = p.lens();
                   for (double& k : lens.radial) k = -k;
                   return PhotoCamera(p.camera(), lens);
                 }});
  all.push_back({"there is no lens distortion: the photographs are undistorted already",
                 [](const PhotoCamera& p) { return PhotoCamera(p.camera(), LensDistortion()); }});
  for (const double d : {0.5, -0.5})
    all.push_back({fmt::format("their principal points are moved by ({0:+}, {0:+}): half a pixel", d),
                   [d](const PhotoCamera& p) { return PhotoCamera(moved(p.camera(), d, d), p.lens()); }});
  for (const double s : {0.25, 0.5, 2.0, 4.0})
    all.push_back({fmt::format("K is multiplied by {}: it belongs to images of another size", s),
                   [s](const PhotoCamera& p) { return PhotoCamera(enlarged(p.camera(), s), p.lens()); }});
  return all;
}

std::vector<const View*> views_with_points(const Capture& capture) {
  std::vector<const View*> out;
  for (const View& v : capture.views)
    if (v.sightings && v.sightings->size() >= kMinSightings) out.push_back(&v);
  return out;
}

double median_of_all(const std::vector<const View*>& views, const Reading* reading) {
  std::vector<double> medians;
  for (const View* v : views) {
    const PhotoCamera camera = camera_of(*v);
    medians.push_back(median_length(residuals(*v, reading ? reading->change(camera) : camera)));
  }
  return median(medians);
}

// The mean is near zero where cameras were adjusted to the points, whatever the noise.
Vec2d usual_bias(const std::vector<const View*>& views) {
  std::vector<double> x, y;
  for (const View* v : views)
    for (const Vec2d r : residuals(*v, camera_of(*v))) x.push_back(r.x), y.push_back(r.y);
  return {median(x), median(y)};
}

void set_photo(View& view, const PhotoCamera& photo) {
  if (view.photo)
    view.photo = photo;
  else
    view.camera = photo.camera();
}

bool is_half_pixel(Vec2d bias) {
  return std::abs(std::abs(bias.x) - 0.5) < 0.15 && std::abs(std::abs(bias.y) - 0.5) < 0.15;
}

// The reading that leaves least, if it explains the residuals.
const Reading* best_reading(const std::vector<Reading>& all, const std::vector<const View*>& views,
                            double now) {
  const Reading* best = nullptr;
  double smallest = kMaxExplainedShare * now;
  for (const Reading& r : all)
    if (const double left = median_of_all(views, &r); left < smallest) smallest = left, best = &r;
  return best;
}

void check_each(const std::vector<const View*>& views, double usual, std::vector<Finding>& findings) {
  std::vector<std::string> odd;
  for (const View* v : views) {
    const double m = median_length(residuals(*v, camera_of(*v)));
    if (m > std::max(3.0, kOutlierFactor * usual)) odd.push_back(v->name);
  }
  if (odd.empty() || 2 * odd.size() > views.size()) return;
  findings.push_back(
      {Severity::warning,
       fmt::format("{} of {} views do not fit the sparse points that they are said to show: {}.", odd.size(),
                   views.size(), some_names(odd)),
       "Their pose, or their image, is that of another photograph: remove them, or match again.", odd,
       removal_of(odd)});
}

}  // namespace

void check_tracks(const Capture& capture, std::vector<Finding>& findings) {
  const std::vector<const View*> views = views_with_points(capture);
  if (views.size() < 2) return;
  const double now = median_of_all(views, nullptr);
  const Camera& first = views[0]->file_camera();
  const double fits = kMaxMedianError * std::max(first.width, first.height) / 1000.0;
  const std::vector<Reading> all = readings();
  const bool half_pixel = is_half_pixel(usual_bias(views));
  const Reading* best = now > std::min(fits, 0.3) || half_pixel ? best_reading(all, views, now) : nullptr;
  if (best && (now > fits || half_pixel || now > 10 * median_of_all(views, best))) {
    findings.push_back(
        {Severity::warning,
         fmt::format("The sparse points are seen {:.2f} pixels from where the cameras put them. The "
                     "cameras fit if {}.",
                     now, best->what),
         "Correct the cameras; `check` can write a corrected copy of the capture.",
         {},
         [change = best->change](Capture& c) {
           for (View& v : c.views) set_photo(v, change(camera_of(v)));
         }});
  } else if (now > 3 * fits) {
    findings.push_back(
        {Severity::warning,
         fmt::format("The sparse points are seen {:.1f} pixels from where the cameras put them.", now),
         "Cameras and points are not of one model, or the camera model is wrong: export them again."});
  } else {
    check_each(views, now, findings);
  }
}

void check_intrinsics(const Capture& capture, std::vector<Finding>& findings) {
  std::vector<double> focal, sx, sy;
  for (const View& v : capture.views) {
    const Camera& c = v.file_camera();
    if (c.width < 1 || !(c.cx > 0 && c.cy > 0)) continue;
    focal.push_back(c.fx / std::max(c.width, c.height));
    sx.push_back(c.width / (2 * c.cx)), sy.push_back(c.height / (2 * c.cy));
  }
  if (focal.empty()) return;
  const double f = median(focal), x = median(sx), y = median(sy);
  if (f < 0.35 || f > 30)
    findings.push_back(
        {Severity::warning,
         fmt::format("The focal length is {:.2g} times the image's longer side, a field of view of {:.3g} "
                     "degrees.",
                     f, 2 * std::atan(0.5 / f) * 180 / M_PI),
         "Give focal lengths in pixels. In millimeters they have to be multiplied by the image width and "
         "divided by the sensor width (36 mm for a 35 mm equivalent)."});
  if (std::abs(x - y) < 0.08 * x && (x > 1.3 || x < 0.77))
    findings.push_back(
        {Severity::warning,
         fmt::format("The principal points lie at {:.2f} of the image width and {:.2f} of its height.",
                     0.5 / x, 0.5 / y),
         fmt::format("K belongs to images of another size: multiply it by {:.3g}.", x),
         {},
         [x](Capture& c) {
           for (View& v : c.views) {
             const PhotoCamera p = camera_of(v);
             set_photo(v, PhotoCamera(enlarged(p.camera(), x), p.lens()));
           }
         }});
}

}  // namespace cei3d
