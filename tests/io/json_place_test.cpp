/// Values in JSON that know where they stand.
#include "batten/io/json_place.h"

#include <gtest/gtest.h>

#include "support/errors.h"

namespace batten::io {
namespace {

void expect_fault(
    const std::string& text, const std::string& message,
    const std::function<void(const JsonPlace&)>& read = [](const JsonPlace&) {}) {
  test::expect_error(
      [&] {
        const JsonName name{"f.json"};
        const Json json = parse_json(name, text);
        read(JsonPlace(name, json));
      },
      ErrorCode::BadFile, "f.json: " + message);
}

TEST(JsonPlace, IsWrittenAsAPath) {
  EXPECT_EQ(path_text({}), "");
  EXPECT_EQ(path_text({{"forces", 0}, {"", 2}, {"at", 0}, {"near", 0}, {"", 1}}), "forces[2].at.near[1]");
}

TEST(JsonPlace, NamesWhatIsNotJson) {
  expect_fault(R"({"a": [1, {"b": nul}]})", "a[1].b: not JSON: parse error");
  expect_fault(R"({"a": [1, 1e999]})", "a[1]: not JSON: number overflow");
}

TEST(JsonPlace, RefusesAKeyThatIsGivenTwice) {
  expect_fault(R"({"a": 1, "b": {"a": 2, "c": 3, "c": 3}})", "b.c: is given twice; leave one of them out");
  const JsonName name{"f.json"};
  EXPECT_EQ(parse_json(name, R"({"a": 1, "b": {"a": 2}, "c": [{"a": 1}, {"a": 1}]})").size(), 3U);
}

TEST(JsonPlace, NamesWhatIsNotOfTheKindExpected) {
  const std::string text = R"({"a": [-3, 0, 1.5, "x", 1e9, true]})";
  const auto at = [&](std::size_t i, const std::string& message, const std::function<void(const JsonPlace&)>& read) {
    expect_fault(text, "a[" + std::to_string(i) + "]: " + message,
                 [&](const JsonPlace& place) { read(place.at("a").item(i)); });
  };
  at(0, "-3 is negative; give 0 or more", [](const JsonPlace& place) { place.not_negative(); });
  at(1, "0 is not above 0", [](const JsonPlace& place) { place.positive(); });
  at(2, "a whole number from 0 on is expected here, not 1.5", [](const JsonPlace& place) { place.index(); });
  at(3, "a number is expected here, not \"x\"", [](const JsonPlace& place) { place.number(); });
  at(1, "true or false is expected here, not 0", [](const JsonPlace& place) { place.truth(); });
  at(2, "one of b, c is expected here, not 1.5", [](const JsonPlace& place) { place.choice({"b", "c"}); });
  expect_fault(R"({"a": 12})", "a: 12 is too much; give 11 or less",
               [](const JsonPlace& place) { place.at("a").index_to(11); });
}

}  // namespace
}  // namespace batten::io
