// SPDX-License-Identifier: Apache-2.0
#include "core/base/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

enum class Taste { sweet, sour };
struct Filling {
  float share = 0.3f;
  Taste taste = Taste::sweet;
};
struct Cake {
  int layers = 4;
  double sugar = 0.5;
  bool baked = false;
  Filling filling;
};

SettingTable<Cake> cakes() {
  SettingTable<Cake> table;
  const SettingGroup<Cake, Cake> cake(table, "", [](Cake& c) -> Cake& { return c; });
  cake.add("layers", &Cake::layers, {2, 8, 2}, "layers", "Number of layers", "[Goesele et al. 2006]")
      .add("sugar", &Cake::sugar, {0, 1}, "", "Share of sugar")
      .add("baked", &Cake::baked, {}, "", "Whether it was baked");
  cake.part("filling.", &Cake::filling)
      .add("share", &Filling::share, {0}, "", "Share of the filling")
      .choice("taste", &Filling::taste, {{Taste::sweet, "sweet"}, {Taste::sour, "sour"}}, "Its taste");
  return table;
}

Cake made(std::initializer_list<const char*> written) {
  const SettingTable<Cake> table = cakes();
  Json values = Json::object();
  for (const char* w : written) add_setting(table.infos(), w, values);
  Cake cake;
  table.put(values, cake);
  return cake;
}

std::string refusal(const char* written) {
  const Error e = error_of([&] { made({written}); });
  EXPECT_EQ(e.code(), ErrorCode::usage) << e.what();
  return e.what();
}

TEST(Settings, SetEveryKindOfMember) {
  const Cake cake =
      made({"layers=6", "sugar=0.25", "baked=true", "filling.share=1e-3", "filling.taste=sour"});
  EXPECT_EQ(cake.layers, 6);
  EXPECT_EQ(cake.sugar, 0.25);
  EXPECT_TRUE(cake.baked);
  EXPECT_EQ(cake.filling.share, 1e-3f);
  EXPECT_EQ(cake.filling.taste, Taste::sour);
  EXPECT_EQ(made({"layers=2", "layers=8"}).layers, 8);
  EXPECT_EQ(made({}).layers, Cake().layers);
}

TEST(Settings, AreListedAsTheyAre) {
  const SettingTable<Cake> table = cakes();
  ASSERT_EQ(table.infos().size(), 5u);
  Json all;
  for (size_t i = 0; i < 5; ++i) all[table.infos()[i].key] = table.get(i, Cake());
  EXPECT_EQ(all.dump(),
            R"({"layers":4,"sugar":0.5,"baked":false,"filling.share":0.3,"filling.taste":"sweet"})");
}

TEST(Settings, WrongOnesSaySo) {
  EXPECT_THAT(refusal("layers"), HasSubstr("key=value"));
  EXPECT_THAT(refusal("=3"), HasSubstr("key=value"));
  EXPECT_THAT(refusal("layer=3"), HasSubstr("'layers'"));
  EXPECT_THAT(refusal("taste=sour"), HasSubstr("'filling.taste'"));
  EXPECT_THAT(refusal("layers=3"), HasSubstr("multiple of 2"));
  EXPECT_THAT(refusal("layers=10"), HasSubstr("2 to 8"));
  EXPECT_THAT(refusal("layers=4.0"), HasSubstr("whole"));
  EXPECT_THAT(refusal("layers=4x"), HasSubstr("whole"));
  EXPECT_THAT(refusal("sugar="), HasSubstr("0 to 1"));
  EXPECT_THAT(refusal("sugar=nan"), HasSubstr("0 to 1"));
  EXPECT_THAT(refusal("filling.share=inf"), HasSubstr("at least 0"));
  EXPECT_THAT(refusal("baked=1"), HasSubstr("true or false"));
  EXPECT_THAT(refusal("filling.taste=bitter"), HasSubstr("sweet, sour"));
}

TEST(Settings, OfAFile) {
  const TempFolder temp;
  const std::string file = (temp.path() / "cake.json").string();
  write_file_atomic(file, R"({"set": {"layers": 8, "filling.taste": "sour"}})");
  const Cake cake = made({("@" + file).c_str(), "layers=6"});
  EXPECT_EQ(cake.layers, 6);
  EXPECT_EQ(cake.filling.taste, Taste::sour);
  write_file_atomic(file, R"({"set": {"layers": 7}})");
  EXPECT_THAT(refusal(("@" + file).c_str()), HasSubstr("multiple of 2"));
  write_file_atomic(file, R"({"set": {"layers": 8}, "sets": {"sugar": 1}})");
  EXPECT_THAT(error_of([&] { made({("@" + file).c_str()}); }).what(), HasSubstr("'sets'"));
  write_file_atomic(file, R"({"settings": {}})");
  EXPECT_THAT(refusal(("@" + file).c_str()), HasSubstr("\"set\""));
  write_file_atomic(file, "{");
  EXPECT_THAT(refusal(("@" + file).c_str()), HasSubstr("\"set\""));
}

}  // namespace
}  // namespace cei3d
