#include "batten/mesh/checked_values.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/error.h"

namespace batten {
namespace {

std::string complaint(ConstValuesRef values) {
  try {
    require_finite(values, "values");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::NotFinite);
    return error.what();
  }
  return {};
}

TEST(RequireFinite, NamesTheFirstBadRow) {
  Values values = Values::Ones(20000, 3);
  values(9, 0) = std::numeric_limits<double>::max();
  EXPECT_EQ(complaint(values), "");
  values(19999, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(values), "row 19999 of the values is not finite");
  values(5000, 2) = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaint(values), "row 5000 of the values is not finite");
}

TEST(RequireFinite, LooksAtABlockOfColumnsOnly) {
  Values values = Values::Ones(100, 4);
  values(50, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(values.leftCols(3)), "");
  EXPECT_EQ(complaint(values.rightCols(2)), "row 50 of the values is not finite");
  EXPECT_EQ(complaint(values.topRows(0)), "");
}

}  // namespace
}  // namespace batten
