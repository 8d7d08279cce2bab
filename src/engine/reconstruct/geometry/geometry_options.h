// SPDX-License-Identifier: Apache-2.0
// Settings of the geometry stage, and what they amount to at one moment of the schedule. Positions in the
// schedule are fractions in [0, 1); lengths are in units of the unit sphere, which the object fills.
#pragma once

#include "model/field/adam_constants.h"
#include "model/field/field.h"

namespace cei3d {

// How rays are sampled. Candidates lie `step_width / inv_s` apart, within [step_min, step_max]: the opacity
// of a section is exact for any length, and jitter makes up for the colors that a longer one misses.
struct SamplingOptions {
  float step_min = 0.006f;     // shortest distance between candidates
  float step_max = 0.02f;      // longest distance between candidates
  float step_width = 2.5f;     // distance between candidates, in standard deviations
  float keep_weight = 0.003f;  // minimum weight of a candidate that becomes a sample, which is rendered
};

// Weights and widths of the losses. inv_s: see GeometrySchedule.
struct GeometryLosses {
  float huber_width = 0.05f;  // color error from which the color loss grows linearly; display-encoded
  float eikonal = 0.3f;       // weight of (|gradient| - 1)^2
  float empty = 0.1f;         // weight of empty_push(), per inv_s
  float anchor = 0.15f;  // weight of the distance to the start shape, per inv_s; fades out, `anchor_until`
};

struct GeometryOptions {
  FieldConfig sdf;            // outputs: distance, then the features that the radiance network reads
  int radiance_layers = 2;    // hidden layers of the radiance network
  int radiance_width = 64;    // width of its hidden layers
  int rays = 2048;            // rays per step; a multiple of kChunkRays
  float inv_s_start = 200;    // inverse standard deviation of the opacity at the beginning, 1 / length
  float inv_s_end = 800;      // inverse standard deviation at the end, to which it grows exponentially
  float inv_s_until = 0.6f;   // position at which inv_s_end is reached
  float unlock_until = 0.3f;  // position at which all hash levels are in use, coarse to fine
  int first_levels = 5;       // hash levels in use from the beginning
  SamplingOptions sampling;
  GeometryLosses loss;
  float table_rate = 3e-3f;  // Adam rate of the hash tables
  float layer_rate = 2e-3f;  // Adam rate of the layers of both networks
  float decay_from = 0.3f;   // position from which both rates decay exponentially
  float decay_to = 0.01f;    // factor of both rates at the end
  int halving_parts = 0;     // if > 0, both rates are halved instead, see halved()
  AdamConstants adam;
  int prefit_steps = 300;        // steps that fit the field to the start shape
  int refresh_every = 10;        // steps between updates of the occupancy grid
  float tight_grid_from = 0.4f;  // position from which the surface moves little and the grid is trusted more
  bool hold_start = false;       // hold every start shape, not only anchored ones, and all around its surface
  float anchor_until = 0.2f;     // position until which a start shape is held, with a weight that falls to 0
};

struct GeometrySchedule {
  float inv_s;          // inverse standard deviation of the opacity, 1 / length
  float step;           // distance between candidates along a ray
  float band;           // distance from the surface within which rays have candidates
  float slack;          // possible error of the occupancy grid, in half diagonals of its cells
  bool view_dependent;  // colors may depend on the view
  float anchor;         // weight of the distance to the start shape
};

inline constexpr int kChunkRays = 64;                  // rays that one task renders
inline constexpr int kChunkSamples = kChunkRays * 32;  // their samples, at most; about five per ray are usual

int levels_at(const GeometryOptions&, double u);
// For a start shape that is held and colors that depend on the view.
GeometrySchedule schedule_at(const GeometryOptions&, double u);
// Factor of the Adam rates: a short warm-up, then a plateau and an exponential decay, or halvings.
float rate_at(const GeometryOptions&, double u);

}  // namespace cei3d
