// SPDX-License-Identifier: Apache-2.0
// How a part is propagated from view to view. [paper Algorithm 1]
#pragma once

#include <limits>

namespace cei3d {

enum class ViewOrder {
  informative,  // the view that adds most to what is known, until none adds anything
  adjacent      // the view nearest to the last one, as in the paper, until all were visited
};

enum class MaskCombination {
  votes,  // the views vote; prompts are corrected, and a mask that contradicts earlier votes is not counted
  any     // the part is what any mask shows, as in the paper
};

struct ViewPlan {
  static constexpr int kAll = std::numeric_limits<int>::max();
  int max_views = 10;  // maximum number of views to segment, the first included
  ViewOrder order = ViewOrder::informative;
  MaskCombination combination = MaskCombination::votes;
};

}  // namespace cei3d
