// Where something that grows, but for noise, comes to 0: between two points, which interpolation brings together.
#ifndef LACERTA_GEOMETRY_ROOT_BRACKET_H_
#define LACERTA_GEOMETRY_ROOT_BRACKET_H_

#include <algorithm>
#include <limits>

namespace lacerta {

class RootBracket {
 public:
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();  // in place of y

  struct Point {
    double x, y;
  };

  // below.y <= 0 < above.y, or kUnknown; x of either may be the smaller one.
  RootBracket(const Point& below, const Point& above) : below_(below), above_(above) {}

  const Point& below() const { return below_; }
  const Point& above() const { return above_; }
  bool IsKnown() const { return below_.y < kUnknown && above_.y < kUnknown; }

  // point: between the two. An end that stays in place counts half the second time ("Illinois" rule), so that it comes nearer, too.
  void Narrow(const Point& point) {
    const bool is_below = point.y <= 0.0;
    Point& stays = is_below ? above_ : below_;
    if (is_narrowed_ && is_below == was_below_ && stays.y < kUnknown) stays.y /= 2;
    (is_below ? below_ : above_) = point;
    was_below_ = is_below;
    is_narrowed_ = true;
  }

  // Where the root seems to be, somewhat off the ends; both have to be known.
  double Next() const {
    constexpr double kEdge = 0.05;
    const double share = below_.y / (below_.y - above_.y);
    return below_.x + std::clamp(share, kEdge, 1.0 - kEdge) * (above_.x - below_.x);
  }

 private:
  Point below_, above_;
  bool is_narrowed_ = false, was_below_ = false;  // the last time
};

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_ROOT_BRACKET_H_
