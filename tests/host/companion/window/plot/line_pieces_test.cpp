// Tests that a reversing line is drawn completely, in several pieces.
#include <doctest/doctest.h>

#include <span>
#include <vector>

#include "host/companion/window/plot/line_pieces.hpp"

using namespace inkwell;

namespace {

struct Spot {
  float x = 0, y = 0;
};

std::vector<std::size_t> lengths_of_pieces(const std::vector<Spot>& line) {
  std::vector<std::size_t> lengths;
  for (const auto piece : window::pieces_between_turns(std::span<const Spot>(line))) lengths.push_back(piece.size());
  return lengths;
}

}  // namespace

TEST_CASE("a line is cut where it turns back, and the pieces share that point") {
  const std::vector<Spot> line{{0, 0}, {1, 1}, {2, 2}, {1.1f, 1}, {0, 0}, {0, 1}};
  const auto pieces = window::pieces_between_turns(std::span<const Spot>(line));
  REQUIRE(pieces.size() == 3);
  CHECK(pieces[0].size() == 3);
  CHECK(&pieces[0].back() == &pieces[1].front());
  CHECK(&pieces[1].back() == &pieces[2].front());
  CHECK(&pieces[2].back() == &line.back());
}

TEST_CASE("a straight line or a line with right angles is one piece, and a single point is not a piece") {
  CHECK(lengths_of_pieces({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {3, 1}}) == std::vector<std::size_t>{5});
  CHECK(lengths_of_pieces({{0, 0}, {5, 5}}) == std::vector<std::size_t>{2});
  CHECK(lengths_of_pieces({{0, 0}}).empty());
  CHECK(lengths_of_pieces({}).empty());
}
