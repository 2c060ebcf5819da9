// Jumps of motions: planted ones are found where they are, and none in motions without.
#include "sim/cam/check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/cam/hermite.hpp"
#include "tests/sim/cam/random_motion.hpp"

namespace stiction::sim::cam {
namespace {

// Adds to one piece a polynomial of 7th degree that is zero at both ends with three derivatives, but for the one of
// `order` at its start or end, which is `height`.
void plant(Piece& piece, int order, double height, bool at_start) {
  double unit = height;
  for (int k = 0; k < order; ++k) unit *= piece.length();
  EndState state;
  (order == 0 ? state.position : order == 1 ? state.speed : order == 2 ? state.acceleration : state.jerk) = unit;
  Piece bump{.begin = piece.begin, .end = piece.end, .rate = 1.0 / piece.length()};
  bump.polynomial = at_start ? septic(state, {}) : septic({}, state);
  // In the variable of the piece: t' = rate' / rate * t, or counted from the other end.
  double factor = bump.rate / piece.rate, power = 1.0;
  if (piece.from_end) bump.polynomial = at_start ? septic({}, state.reversed()) : septic(state.reversed(), {});
  piece.polynomial.resize(std::max<std::size_t>(piece.polynomial.size(), 8), 0.0);
  for (std::size_t n = 0; n < 8; ++n, power *= factor) piece.polynomial[n] += bump.polynomial[n] * power;
}

struct Planted {
  Motion motion;
  double place;
  int order;
  JumpPlace where;
};

Planted planted(std::uint64_t seed) {
  RandomMotion random(seed);
  const Motion clean = compose(random.septics(2 + random.whole(6)));
  const auto& segments = clean.segments;
  const std::size_t k = random.whole(segments.size());
  const int order = static_cast<int>(random.whole(4)), kind = static_cast<int>(random.whole(3));
  // A Hermite segment has two pieces: its joint is inside of it.
  const std::size_t piece = kind == 0   ? segments[k].first_piece + 1
                            : kind == 1 ? segments[1 + random.whole(segments.size() - 1)].first_piece
                                        : 0;
  auto pieces = clean.curve.pieces();
  const auto range = extremes(clean.curve, order);
  const double peak = order == 0 ? range.highest.value - range.lowest.value : range.magnitude();
  const double height = 1e-6 * peak * (random.whole(2) == 0 ? 1.0 : -1.0);
  const double place = kind == 2 ? clean.curve.end() : pieces[piece].begin;
  if (kind == 2 && random.whole(2) == 0)
    plant(pieces.back(), order, height, false);
  else
    plant(pieces[piece], order, height, true);
  Motion motion = clean;
  motion.curve = Curve(std::move(pieces));
  return {std::move(motion), place, order,
          kind == 0   ? JumpPlace::inside
          : kind == 1 ? JumpPlace::joint
                      : JumpPlace::seam};
}

TEST(CamCheck, FindsOnePlantedJumpInEachOf200Motions) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto wanted = planted(seed);
    const auto found = jumps_of(wanted.motion);
    ASSERT_EQ(found.size(), 1u) << "seed " << seed << ", order " << wanted.order;
    EXPECT_EQ(found[0].jump.order, wanted.order) << seed;
    EXPECT_NEAR(found[0].jump.place, wanted.place, 1e-12) << seed;
    EXPECT_EQ(found[0].where, wanted.where) << seed;
    EXPECT_NEAR(found[0].share, 1e-6, 1e-8) << seed;
  }
}

TEST(CamCheck, FindsNoneIn200MotionsThatAreContinuousToTheJerk) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomMotion random(1000 + seed);
    EXPECT_TRUE(jumps_of(compose(random.septics(2 + random.whole(10)))).empty()) << seed;
  }
}

TEST(CamCheck, FindsOnlyJerkStepsIn200MotionsFromRestToRest) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomMotion random(2000 + seed);
    for (const auto& jump : jumps_of(compose(random.rests(2 + random.whole(10)))))
      EXPECT_EQ(jump.jump.order, 3) << seed;
  }
}

TEST(CamCheck, FindsTheJumpsThatALawHasByItself) {
  Cam cam{.name = "parabolas"};
  cam.segments = {{.length = 3.0, .stroke = 1.0, .law = "parabola"}, {.length = 3.0, .stroke = -1.0, .law = "cubic"}};
  int inside = 0, joints = 0, seams = 0;
  for (const auto& jump : jumps_of(compose(cam))) {
    if (jump.jump.order != 2) continue;
    inside += jump.where == JumpPlace::inside;
    joints += jump.where == JumpPlace::joint;
    seams += jump.where == JumpPlace::seam;
  }
  EXPECT_EQ(inside, 1);  // the parabola's
  EXPECT_EQ(joints, 1);  // -4/9 against -6/9
  EXPECT_EQ(seams, 1);
}

TEST(CamCheck, ACamThatRunsOnceMustBeginAndEndAtRest) {
  Cam cam{.name = "once", .periodic = false};
  cam.segments = {{.length = 1.0, .stroke = 1.0, .law = "linear"}};
  const auto jumps = jumps_of(compose(cam));
  ASSERT_EQ(jumps.size(), 2u);
  for (const auto& jump : jumps) {
    EXPECT_EQ(jump.where, JumpPlace::ends);
    EXPECT_EQ(jump.jump.order, 1);
  }
}

TEST(CamCheck, AnEndlessSlaveMayAdvanceByWholeTurns) {
  Cam cam{.name = "turns", .modulo = 2.0};
  cam.segments = {{.length = 1.0, .stroke = 4.0, .law = "linear"}};
  EXPECT_TRUE(jumps_of(compose(cam)).empty());
}

}  // namespace
}  // namespace stiction::sim::cam
