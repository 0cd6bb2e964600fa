// Shares of a whole, and two methods on the same things.
#pragma once

#include <cstdint>
#include <optional>

namespace retrolux {

struct Interval {
  double low = 0.0, high = 1.0;
};

// `count` of `of`.
struct Proportion {
  int64_t count = 0, of = 0;

  // Nothing of nothing has no value.
  std::optional<double> Value() const;
  // 95 % score interval of E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209: the probabilities from
  // which the share lies no more than 1.96 standard deviations. It holds its level for shares near
  // 0 and 1, too. [0, 1] of nothing.
  Interval Wilson() const;
};

// Two-sided exact p of McNemar's test that two methods find the same share, of the things that only
// one of the two found: the probability that fair coins fall at least as unevenly. Psychometrika 12
// (1947) 153, with the binomial distribution itself.
double McNemarExactP(int64_t first_only, int64_t second_only);

}  // namespace retrolux
