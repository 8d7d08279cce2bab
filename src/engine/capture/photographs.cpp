// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/photographs.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "engine/capture/capture_format.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/doctor.h"
#include "engine/capture/find_masks.h"
#include "engine/capture/normalize.h"
#include "engine/capture/undistort.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

bool is_missing(const View& view) { return !view.image_path.empty() && !fs::exists(view.image_path); }

void drop_missing(Capture& capture) {
  std::vector<std::string> missing;
  size_t with_image = 0;
  for (const View& v : capture.views) {
    with_image += !v.image_path.empty();
    if (is_missing(v)) missing.push_back(v.name);
  }
  if (missing.empty() || 2 * missing.size() > with_image) return;
  std::erase_if(capture.views, is_missing);
  capture.warnings.push_back(fmt::format("{} of {} images are missing; their views are left out: {}.",
                                         missing.size(), with_image, some_names(missing)));
}

Camera scaled_camera(Camera c, ImageSize to) {
  const double sx = double(to.width) / c.width, sy = double(to.height) / c.height;
  c.width = to.width, c.height = to.height;
  c.fx *= sx, c.cx *= sx, c.skew *= sx;
  c.fy *= sy, c.cy *= sy;
  return c;
}

// Whether the camera of the view was scaled to the image. Images of other proportions are left to check().
bool scale_to_image(View& view) {
  const Camera& c = view.file_camera();
  const ImageSize have{c.width, c.height};
  ImageSize size = size_of_image(view.image_path);
  if (size.width == 0 || size == have) return false;
  if (size.width == have.height && size.height == have.width) return false;  // turned by EXIF when it is read
  if (!same_proportions(size, have)) return false;
  const Camera scaled = scaled_camera(c, size);
  if (view.photo)
    view.photo = PhotoCamera(scaled, view.photo->lens());
  else
    view.camera = scaled;
  return true;
}

void scale_to_images(Capture& capture) {
  std::vector<ImageSize> before;
  for (const View& v : capture.views) before.push_back({v.file_camera().width, v.file_camera().height});
  std::vector<uint8_t> scaled(capture.views.size());
  parallel_for(int(capture.views.size()), [&](int i) { scaled[i] = scale_to_image(capture.views[i]); });
  const auto first = std::find(scaled.begin(), scaled.end(), 1);
  if (first == scaled.end()) return;
  const auto i = size_t(first - scaled.begin());
  const Camera& c = capture.views[i].file_camera();
  capture.warnings.push_back(
      fmt::format("The cameras of {} of {} views were scaled to their images ({}: from {} x {} to {} x {}).",
                  std::count(scaled.begin(), scaled.end(), 1), scaled.size(), capture.views[i].name,
                  before[i].width, before[i].height, c.width, c.height));
}

// What the mask of a view says on the photograph.
struct MaskLook {
  bool stated = false;
  double border = 0, share = 0;  // object pixels of the outermost pixels, and of all
  PhotoBox object;               // around the object pixels
};

void extend(PhotoBox& box, int x, int y) {
  if (box.x1 == 0) box = {x, y, x + 1, y + 1};
  box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1), std::max(box.y1, y + 1)};
}

MaskLook look_at_mask(const View& view) {
  MaskLook look;
  Mask mask;
  try {
    mask = load_file_mask(view);
  } catch (const Error&) {
    return look;  // check() reports it
  }
  look.stated = mask.stated;
  int border = 0, set_on_border = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const bool object = mask.object[size_t(y) * mask.width + x] == kObject;
      const bool outermost = x == 0 || y == 0 || x == mask.width - 1 || y == mask.height - 1;
      border += outermost;
      set_on_border += outermost && object;
      look.share += object;
      if (object) extend(look.object, x, y);
    }
  look.border = double(set_on_border) / std::max(border, 1);
  look.share /= double(std::max<size_t>(mask.object.size(), 1));
  return look;
}

std::vector<MaskLook> look_at_masks(const Capture& capture, bool (*wanted)(const View&)) {
  std::vector<MaskLook> looks(capture.views.size());
  parallel_for(int(looks.size()), [&](int i) {
    if (wanted(capture.views[i])) looks[i] = look_at_mask(capture.views[i]);
  });
  return looks;
}

// Whether the masks, read the other way round, have a volume in common. Small masks are enough for that.
bool inverted_masks_agree(const Capture& capture) {
  std::vector<Mask> masks;
  std::vector<Camera> cameras;
  for (const View& v : capture.views) {
    if (v.mask_path.empty() || v.split != Split::train) continue;
    const Mask full = load_file_mask(v);
    const int n = std::max(1, full.width / 160);
    const Camera small = scaled(v.file_camera(), n);
    Mask mask{small.width, small.height, {}, true};
    for (int y = 0; y < small.height; ++y)
      for (int x = 0; x < small.width; ++x)
        mask.object.push_back(full.object[size_t(y * n) * full.width + x * n] == kObject ? kBackground
                                                                                         : kObject);
    masks.push_back(std::move(mask));
    cameras.push_back(small);
  }
  std::vector<HullMask> hull;
  for (size_t i = 0; i < masks.size(); ++i) hull.push_back({cameras[i], masks[i].object});
  try {
    normalization_from_masks(hull);
    return true;
  } catch (const Error&) {
    return false;
  }
}

bool has_mask_file(const View& view) { return !view.mask_path.empty() && fs::exists(view.mask_path); }

// Programs disagree on whether white or black means the object. What borders the image is background.
void decide_polarity(Capture& capture) {
  const std::vector<MaskLook> looks = look_at_masks(capture, has_mask_file);
  size_t stated = 0, inside_out = 0;
  for (const MaskLook& look : looks) {
    stated += look.stated;
    inside_out += look.stated && look.border > 0.8 && look.share < 0.99;
  }
  if (stated < 2 || double(inside_out) < 0.8 * double(stated) || !inverted_masks_agree(capture)) return;
  for (View& v : capture.views) v.dark_object = !v.mask_path.empty();
  capture.warnings.push_back(fmt::format(
      "The masks are bright at the borders of {} of {} images, so dark was taken to mean the object.",
      inside_out, stated));
}

void find_masks(Capture& capture) {
  for (View& v : capture.views)
    if (v.mask_path.empty() && !v.image_path.empty()) v.mask_path = find_mask(capture.root, v.image_path);
}

void frame_objects(Capture& capture) {
  const std::vector<MaskLook> looks =
      look_at_masks(capture, [](const View& v) { return v.photo.has_value(); });
  for (size_t i = 0; i < looks.size(); ++i) {
    View& v = capture.views[i];
    if (!v.photo) continue;
    const bool framed = looks[i].stated && looks[i].object.x1 > 0;
    const Camera& c = v.photo->camera();
    v.camera = pinhole_around(*v.photo, framed ? looks[i].object : PhotoBox{0, 0, c.width, c.height}, v.name);
  }
}

}  // namespace

void fit_to_photographs(Capture& capture, bool strict) {
  if (!strict) drop_missing(capture);
  scale_to_images(capture);
  find_masks(capture);
  decide_polarity(capture);
  frame_objects(capture);
}

}  // namespace cei3d
