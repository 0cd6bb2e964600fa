// All that `retrolux validate` checks.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>

#include "analysis/check.h"

namespace retrolux {
namespace {

class PhysicalChecks : public testing::TestWithParam<CheckGroup> {};

TEST_P(PhysicalChecks, MeasureWhatTheyMust) {
  for (const Check& check : GetParam().run()) {
    EXPECT_TRUE(check.Pass()) << check.name << ": measured " << check.measured << " " << check.unit
                              << ", expected " << check.expected << " +- " << check.tolerance
                              << " (" << check.source << ")";
    RecordProperty(check.name, std::to_string(check.measured));
  }
}
INSTANTIATE_TEST_SUITE_P(All, PhysicalChecks, testing::ValuesIn(CheckGroups()),
                         [](const auto& group) {
                           std::string name = group.param.name;
                           for (char& c : name)
                             c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

TEST(Check, NaNFails) {
  EXPECT_FALSE((Check{"", std::nan(""), 1.0, 1e9, "", ""}.Pass()));
}

}  // namespace
}  // namespace retrolux
