// SPDX-License-Identifier: Apache-2.0
#include "engine/io/exif.h"

#include <libexif/exif-data.h>

#include <memory>

namespace cei3d {
namespace {

struct Release {
  void operator()(ExifData* data) const { exif_data_unref(data); }
};

const ExifEntry* entry_of(ExifData* data, ExifIfd folder, ExifTag tag, ExifFormat format, unsigned bytes) {
  const ExifEntry* e = exif_content_get_entry(data->ifd[folder], tag);
  return e && e->format == format && e->size >= bytes ? e : nullptr;
}

std::optional<double> ratio(ExifData* data, ExifTag tag) {
  const ExifEntry* e = entry_of(data, EXIF_IFD_EXIF, tag, EXIF_FORMAT_RATIONAL, 8);
  if (!e) return std::nullopt;
  const ExifRational r = exif_get_rational(e->data, exif_data_get_byte_order(data));
  if (r.numerator == 0 || r.denominator == 0) return std::nullopt;
  return double(r.numerator) / r.denominator;
}

std::optional<int> short_of(ExifData* data, ExifIfd folder, ExifTag tag) {
  const ExifEntry* e = entry_of(data, folder, tag, EXIF_FORMAT_SHORT, 2);
  if (!e) return std::nullopt;
  return exif_get_short(e->data, exif_data_get_byte_order(data));
}

}  // namespace

ExifNotes read_exif(const std::string& bytes) {
  ExifNotes notes;
  const std::unique_ptr<ExifData, Release> data(
      exif_data_new_from_data(reinterpret_cast<const unsigned char*>(bytes.data()), unsigned(bytes.size())));
  if (!data) return notes;
  const int orientation = short_of(data.get(), EXIF_IFD_0, EXIF_TAG_ORIENTATION).value_or(1);
  if (orientation >= 1 && orientation <= 8) notes.orientation = orientation;
  const auto time = ratio(data.get(), EXIF_TAG_EXPOSURE_TIME), aperture = ratio(data.get(), EXIF_TAG_FNUMBER);
  const auto iso = short_of(data.get(), EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS);
  if (time && aperture && iso && *iso > 0) notes.exposure = *time * *iso / (*aperture * *aperture);
  notes.focal_length = ratio(data.get(), EXIF_TAG_FOCAL_LENGTH);
  const auto white = short_of(data.get(), EXIF_IFD_EXIF, EXIF_TAG_WHITE_BALANCE);
  if (white && (*white == 0 || *white == 1)) notes.auto_white = *white == 0;
  return notes;
}

}  // namespace cei3d
