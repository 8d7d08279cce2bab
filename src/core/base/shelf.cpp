// SPDX-License-Identifier: Apache-2.0
#include "core/base/shelf.h"

#include <algorithm>

#include "core/base/error.h"

namespace cei3d {

std::shared_ptr<Shelf::Slot> Shelf::put(std::shared_ptr<Shelf> shelf, std::string name, size_t bytes,
                                        std::shared_ptr<const void> value,
                                        std::function<std::shared_ptr<const void>()> read) {
  auto slot = std::make_shared<Slot>();
  slot->bytes_ = bytes;
  slot->read_ = std::move(read);
  slot->value_ = std::move(value);
  {
    const std::lock_guard lock(shelf->mutex_);
    slot->place_ = shelf->all_.emplace(std::move(name), slot);
  }
  slot->shelf_ = std::move(shelf);
  slot->shelf_->add(*slot);
  return slot;
}

size_t Shelf::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void Shelf::keep(const std::string& name) {
  std::vector<std::shared_ptr<Slot>> slots;
  {
    const std::lock_guard lock(mutex_);
    for (auto [it, end] = all_.equal_range(name); it != end; ++it)
      if (auto slot = it->second.lock()) slots.push_back(std::move(slot));
  }
  for (const std::shared_ptr<Slot>& slot : slots) {
    {
      const std::lock_guard lock(slot->mutex_);
      slot->kept_ = true;
    }
    try {
      slot->get();
    } catch (const Error&) {  // reported at the next get()
    }
  }
}

void Shelf::limit(size_t max_bytes) {
  Values dropped;  // destroyed after the lock is released
  const std::lock_guard lock(mutex_);
  max_bytes_ = max_bytes;
  dropped = drop(nullptr);
}

void Shelf::add(Slot& slot) {
  Values dropped;  // destroyed after the lock is released
  const std::lock_guard lock(mutex_);
  if (!slot.resident_) {
    resident_.push_back(&slot);
    bytes_ += slot.bytes_;
    slot.resident_ = true;
  }
  dropped = drop(&slot);
}

// Considers the slots in turn, at most twice each: a slot that was used since it was last considered stays,
// and loses its mark, so that the second time it can be dropped.
Shelf::Values Shelf::drop(const Slot* but) {
  Values dropped;
  for (size_t left = 2 * resident_.size(); bytes_ > max_bytes_ && resident_.size() > 1 && left > 0; --left) {
    Slot& oldest = *resident_.front();
    const std::lock_guard slot_lock(oldest.mutex_);
    if (oldest.kept_ || oldest.used_ || &oldest == but) {
      oldest.used_ = false;
      resident_.splice(resident_.end(), resident_, resident_.begin());
      continue;
    }
    dropped.push_back(std::move(oldest.value_));
    oldest.value_ = nullptr;
    oldest.resident_ = false;
    bytes_ -= oldest.bytes_;
    resident_.pop_front();
  }
  return dropped;
}

void Shelf::remove(Slot& slot) {
  const std::lock_guard lock(mutex_);
  all_.erase(slot.place_);
  if (!slot.resident_) return;
  resident_.remove(&slot);
  bytes_ -= slot.bytes_;
}

Shelf::Slot::~Slot() {
  if (shelf_) shelf_->remove(*this);
}

std::shared_ptr<const void> Shelf::Slot::get() {
  {
    const std::lock_guard lock(mutex_);
    used_ = true;
    if (value_) return value_;
  }
  std::shared_ptr<const void> value = read_();
  ++shelf_->reads_;
  {
    const std::lock_guard lock(mutex_);
    if (!value_) value_ = value;
    value = value_;
  }
  shelf_->add(*this);
  return value;
}

}  // namespace cei3d
