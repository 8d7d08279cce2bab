// SPDX-License-Identifier: Apache-2.0
// Makes the steps of an object within an attempt.
#pragma once

#include "engine/batch/attempt.h"
#include "engine/batch/steps.h"

namespace cei3d {

// Cancelled when the attempt is lost or the catalog is cancelled, too.
class ItemProgress : public Progress {
 public:
  ItemProgress(Progress& listener, const BatchAttempt& attempt) : listener_(listener), attempt_(attempt) {}

 private:
  void on_report(const ProgressReport& r) override { listener_.report(r); }
  void on_log(const std::string& line) override { listener_.log(line); }
  bool is_cancelled() const override {
    return listener_.cancelled() || attempt_.lost() || attempt_.cancelled();
  }

  Progress& listener_;
  const BatchAttempt& attempt_;
};

// Makes what is not done yet and publishes it step by step. Returns what the steps found, by their names,
// such as "figures", with "seconds" in each. Errors: as the steps; again: another worker has taken over.
Json make_item(const BatchSteps&, BatchAttempt&, Session&, Progress&);

}  // namespace cei3d
