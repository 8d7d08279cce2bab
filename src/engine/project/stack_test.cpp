// SPDX-License-Identifier: Apache-2.0
#include "engine/project/stack.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

// What the stack should be, kept the slow way: done and undone edits in two lists.
struct Model {
  std::vector<StackEntry> done, undone;  // undone: nearest last
  std::vector<std::string> active() const {
    std::vector<std::string> ids;
    for (const StackEntry& e : done)
      if (e.enabled) ids.push_back(e.id);
    return ids;
  }
};

void expect_equal(const Stack& stack, const Model& model) {
  EXPECT_EQ(stack.active(), model.active());
  EXPECT_EQ(stack.cursor(), model.done.size());
  std::vector<StackEntry> all = model.done;
  all.insert(all.end(), model.undone.rbegin(), model.undone.rend());
  EXPECT_EQ(stack.entries(), all);
}

void random_step(Stack& stack, Model& model, Rng& rng) {
  switch (rng.below(4)) {
    case 0: {
      const std::string id = stack.next_id("paint");
      stack.push(id);
      model.done.push_back({id, true});
      model.undone.clear();
      break;
    }
    case 1:
      if (model.done.empty()) {
        EXPECT_THROW(stack.undo(), Error);
      } else {
        EXPECT_EQ(stack.undo(), model.done.back().id);
        model.undone.push_back(model.done.back());
        model.done.pop_back();
      }
      break;
    case 2:
      if (model.undone.empty()) {
        EXPECT_THROW(stack.redo(), Error);
      } else {
        EXPECT_EQ(stack.redo(), model.undone.back().id);
        model.done.push_back(model.undone.back());
        model.undone.pop_back();
      }
      break;
    default: {
      const size_t n = model.done.size() + model.undone.size();
      if (n == 0) break;
      const size_t k = rng.below(uint32_t(n));
      StackEntry& e = k < model.done.size() ? model.done[k] : model.undone[k - model.done.size()];
      e.enabled = !e.enabled;
      EXPECT_EQ(stack.toggle(e.id), e.enabled);
    }
  }
}

TEST(Stack, RandomSequencesAgreeWithTwoLists) {
  for (int seed = 0; seed < 50; ++seed) {
    Stack stack;
    Model model;
    for (int i = 0; i < 60; ++i) {
      Rng rng(seed, i, 0);
      random_step(stack, model, rng);
      expect_equal(stack, model);
      EXPECT_EQ(Stack::from_json(stack.to_json(), "stack.json"), stack);
    }
  }
}

TEST(Stack, UndoingAllAndRedoingAllChangesNothing) {
  Stack stack;
  Model model;
  for (int i = 0; i < 40; ++i) {
    Rng rng(7, i, 0);
    random_step(stack, model, rng);
  }
  while (stack.cursor() < stack.entries().size()) stack.redo();
  const Stack before = stack;
  const size_t n = stack.cursor();
  for (size_t i = 0; i < n; ++i) stack.undo();
  EXPECT_TRUE(stack.active().empty());
  for (size_t i = 0; i < n; ++i) stack.redo();
  EXPECT_EQ(stack, before);
}

TEST(Stack, NumbersAreNeverUsedTwice) {
  Stack stack;
  std::set<std::string> seen;
  for (int i = 0; i < 20; ++i) {
    const std::string id = stack.next_id("paint");
    EXPECT_TRUE(seen.insert(id).second) << id;
    stack.push(id);
    if (i % 3 == 0) stack.undo();
  }
}

std::vector<std::string> ids_of(const std::vector<StackEntry>& entries) {
  std::vector<std::string> ids;
  for (const StackEntry& e : entries) ids.push_back(e.id);
  return ids;
}

using Ids = std::vector<std::string>;

TEST(Stack, WhatIsDisplacedComesBackWhereItStood) {
  Stack stack;
  for (const char* id : {"0001-a", "0002-b", "0003-c"}) stack.push(id);
  stack.go_to(1);
  stack.push("0004-d");
  ASSERT_EQ(stack.set_aside().size(), 1u);
  EXPECT_EQ(stack.set_aside()[0].after, "0001-a");
  EXPECT_EQ(ids_of(stack.set_aside()[0].entries), (Ids{"0002-b", "0003-c"}));
  EXPECT_TRUE(stack.contains("0003-c"));
  EXPECT_EQ(Stack::from_json(stack.to_json(), "stack.json"), stack);
  stack.restore("0003-c");
  EXPECT_EQ(ids_of(stack.entries()), (Ids{"0001-a", "0002-b", "0003-c"}));
  EXPECT_EQ(stack.cursor(), 3u);
  EXPECT_EQ(ids_of(stack.set_aside()[0].entries), (Ids{"0004-d"}));
  EXPECT_THROW(stack.restore("0003-c"), Error);
  stack.forget();
  EXPECT_FALSE(stack.contains("0004-d"));
}

TEST(Stack, AnAmendedEditIsOneStep) {
  Stack stack;
  stack.push("0001-a");
  stack.push("0002-b");
  stack.rename("0002-b", "shiny");
  stack.undo();
  stack.push("0003-c");
  stack.amend("0004-c");
  stack.amend("0005-c");
  EXPECT_EQ(ids_of(stack.entries()), (Ids{"0001-a", "0005-c"}));
  EXPECT_EQ(stack.next_id("x"), "0006-x");
  stack.restore("0002-b");
  EXPECT_EQ(stack.entries()[1].name, "shiny");
  EXPECT_EQ(Stack::from_json(stack.to_json(), "stack.json"), stack);
  EXPECT_THROW(stack.rename("0002-b", "two\nlines"), Error);
  EXPECT_THROW(stack.go_to(3), Error);
}

TEST(Stack, DamagedFilesAreRefused) {
  const Json good = {{"edits", {{{"id", "0001-paint"}, {"enabled", true}}}}, {"cursor", 1}, {"next", 2}};
  EXPECT_NO_THROW(Stack::from_json(good, "stack.json"));
  for (const char* patch : {R"({"cursor": 2})", R"({"cursor": "x"})", R"({"edits": 3})", R"({"next": null})",
                            R"({"edits": [{"id": "../../home", "enabled": true}]})", R"({"cursors": 1})",
                            R"({"edits": [{"id": "0001-paint", "enabled": true, "color": 1}]})",
                            R"({"set_aside": [{"after": "", "edits": [{"id": "..", "enabled": true}]}]})"}) {
    Json bad = good;
    bad.update(Json::parse(patch));
    EXPECT_THROW(Stack::from_json(bad, "stack.json"), Error) << patch;
  }
}

}  // namespace
}  // namespace cei3d
