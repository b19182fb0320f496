#include <cmath>

#include <doctest/doctest.h>

#include "host/companion/window/plot/line_thinning.hpp"

using namespace inkwell;

namespace {

struct Point {
  float x = 0, y = 0;
};
using Line = std::vector<Point>;

Line thinned(const Line& points) {
  window::LineThinning<Point> thinning;
  for (const Point& point : points) thinning.add(point);
  return thinning.take();
}

/// Distance from the nearest segment of the line.
float distance(const Line& line, Point point) {
  float nearest = 1e9f;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const float dx = line[i + 1].x - line[i].x, dy = line[i + 1].y - line[i].y;
    const float along = ((point.x - line[i].x) * dx + (point.y - line[i].y) * dy) / (dx * dx + dy * dy);
    const float part = std::min(1.0f, std::max(0.0f, along));
    nearest = std::min(nearest, std::hypot(point.x - line[i].x - part * dx, point.y - line[i].y - part * dy));
  }
  return nearest;
}

TEST_CASE("a straight line keeps its ends, a bend its corner") {
  Line points;
  for (int i = 0; i <= 100; ++i) {
    const float t = static_cast<float>(i);
    points.push_back({2.0f * t, i < 50 ? 10.0f : 10.0f + 3.0f * (t - 50.0f)});
  }
  const Line line = thinned(points);
  REQUIRE(line.size() <= 4);
  CHECK(line.front().x == 0.0f);
  CHECK(line.back().x == 200.0f);
  for (const Point& point : points) CHECK(distance(line, point) < 0.25f);
}

TEST_CASE("no point is visibly far from the thinned line, in any direction") {
  Line wave, circle;
  for (int i = 0; i < 2000; ++i) {
    const float t = static_cast<float>(i) * 0.01f;
    wave.push_back({20.0f * t, 40.0f * std::sin(t) + (i % 7 == 0 ? 3.0f : 0.0f)});
    circle.push_back({50.0f * std::cos(t), 50.0f * std::sin(t)});
  }
  for (const Line& points : {wave, circle}) {
    const Line line = thinned(points);
    CHECK(line.size() < points.size());
    float farthest = 0;
    for (const Point& point : points) farthest = std::max(farthest, distance(line, point));
    CHECK(farthest < 0.4f);
  }
}

TEST_CASE("a line that turns back on itself keeps the turn") {
  const Line line = thinned({{0, 0}, {10, 0}, {20, 0}, {10, 0}, {-10, 0}, {5, 0}});
  float rightmost = 0, leftmost = 0;
  for (const Point& point : line) {
    rightmost = std::max(rightmost, point.x);
    leftmost = std::min(leftmost, point.x);
  }
  CHECK(rightmost == 20.0f);
  CHECK(leftmost == -10.0f);
}

TEST_CASE("points on one vertical are kept, and a resting point is one") {
  CHECK(thinned({{0, 0}, {0, 50}, {0, -50}, {1, 0}}).size() == 4);
  CHECK(thinned(Line(100, Point{3, 4})).size() == 1);
}

}  // namespace
