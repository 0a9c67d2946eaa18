#include "src/picture/legend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/picture/categories.h"
#include "src/picture/text.h"

namespace spillway::test {
namespace {

TEST(ScaleBar, IsTheLongestRoundOneInAQuarterOfThePicture) {
  for (const double side : {0.013, 0.1, 0.7, 1.0, 3.3, 40.0}) {
    const ScaleBar bar = choose_scale_bar(1000, side, 0);
    EXPECT_LE(bar.pixels, 250) << side;
    EXPECT_GT(bar.pixels * 2.5, 250) << side;
    const double length = bar.pixels * side;
    const double digit = length / std::pow(10, std::floor(std::log10(length) + 1e-9));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-9 || std::abs(digit - 2) < 1e-9 ||
                std::abs(digit - 5) < 1e-9)
        << length;
  }
}

TEST(ScaleBar, TellsItsUnit) {
  EXPECT_EQ(choose_scale_bar(1000, 1, 1).text, "200 m");
  EXPECT_EQ(choose_scale_bar(1000, 20, 1).text, "5 km");
  EXPECT_EQ(choose_scale_bar(1000, 1, 0.3048).text, "200 ft");
  EXPECT_EQ(choose_scale_bar(1000, 1, 1200.0 / 3937).text, "200 ft");
  EXPECT_EQ(choose_scale_bar(1000, 1, 0).text, "200");
  EXPECT_EQ(choose_scale_bar(1000, 1e-5, 0).text, "0.002");
}

TEST(Text, IsAsWideAsItSays) {
  for (const std::string_view text : {"8", "mm", "1.5 km", "medium vegetation"}) {
    Picture picture(400, 20);
    draw_text(picture, 3, 2, text, 2, kBlack);
    std::uint32_t last = 0;
    std::uint32_t first = picture.columns();
    for (std::uint32_t row = 0; row < picture.rows(); ++row) {
      for (std::uint32_t column = 0; column < picture.columns(); ++column) {
        if (picture.opacity(column, row) == 0) continue;
        EXPECT_GE(row, 2U);
        EXPECT_LT(row, 2 + 2 * kTextRows);
        first = std::min(first, column);
        last = std::max(last, column);
      }
    }
    EXPECT_GE(first, 3U);
    EXPECT_LT(last, 3 + text_width(text, 2)) << text;
    EXPECT_GE(last + 5, 3 + text_width(text, 2)) << text;
  }
}

TEST(Text, WhatIsBeyondThePictureIsLeftOut) {
  Picture picture(10, 5);
  draw_text(picture, 7, 2, "888", 3, kBlack);
  EXPECT_EQ(picture.bytes().size(), 10U * 5 * 4);
}

TEST(Legend, ItemsThatDoNotFitBesideEachOtherComeBelow) {
  Legend legend{.title = "class"};
  for (int i = 2; i < 5; ++i) {
    const Category category = category_of_class(static_cast<std::uint8_t>(i));
    legend.entries.push_back({as_colour(category.colour), category.name});
  }
  Picture wide(2000, 10);
  Picture narrow(150, 10);
  add_strip(wide, std::nullopt, legend, false);
  add_strip(narrow, std::nullopt, legend, false);
  const std::uint32_t dot = 2000 / 350;
  EXPECT_LT(wide.rows() - 10, 25 * dot);
  EXPECT_GT(narrow.rows() - 10, 40U);
  EXPECT_EQ(wide.opacity(0, wide.rows() - 1), 255);
}

TEST(Categories, AreToldApart) {
  for (int i = 0; i < 22; ++i) {
    EXPECT_NE(category_of_class(static_cast<std::uint8_t>(i)).colour,
              category_of_class(static_cast<std::uint8_t>(i + 1)).colour);
  }
  EXPECT_EQ(category_of_class(2).name, "ground");
  EXPECT_EQ(category_of_class(9).name, "water");
  EXPECT_EQ(category_of_class(200).name, "class 200");
  EXPECT_EQ(category_of_return(15).colour, category_of_return(9).colour);
  EXPECT_NE(category_of_return(0).colour, category_of_return(1).colour);
}

}  // namespace
}  // namespace spillway::test
