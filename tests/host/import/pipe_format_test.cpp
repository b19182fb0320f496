// Messages of the helper program, complete and damaged.
#include <doctest/doctest.h>

#include <cstring>

#include "host/import/error.hpp"
#include "host/import/pipe_format.hpp"
#include "tests/failure.hpp"

using namespace inkwell;
using importer::decode;
using tests::contains;
using tests::message_of;

namespace {

const importer::FileContent content{.vertices = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9e100}},
                                    .faces = {{0, 1, 2}},
                                    .unit = importer::Unit::inch,
                                    .is_unit_doubtful = true,
                                    .remarks = {"One.", ""}};

}  // namespace

TEST_CASE("a message contains vertices, triangles, unit and remarks") {
  const auto decoded = decode(importer::encode(content), "a.obj");
  CHECK(decoded.vertices == content.vertices);
  CHECK(decoded.faces == content.faces);
  CHECK(decoded.unit == importer::Unit::inch);
  CHECK(decoded.is_unit_doubtful);
  CHECK(decoded.remarks == content.remarks);
  CHECK_FALSE(decode(importer::encode({}), "a.obj").unit.has_value());
  CHECK(message_of<importer::Error>([] { decode(importer::encode_refusal("No \x1B[1m."), "a.obj"); }) == "No ?[1m.");
}

TEST_CASE("each incomplete or damaged message is refused") {
  const auto message = importer::encode(content);
  for (std::size_t size = 0; size < message.size(); ++size)
    CHECK(contains(message_of<importer::Error>([&] { decode(std::span(message).first(size), "a.obj"); }),
                   "The reader of a.obj stopped"));
  auto longer = message;
  longer.push_back({});
  CHECK_THROWS_AS(decode(longer, "a.obj"), importer::Error);
  for (const std::size_t field : {4u, 12u, 20u, 28u}) {  // vertices, faces, unit, remarks
    auto damaged = message;
    damaged[field + 3] = std::byte{0x7F};
    CHECK_THROWS_AS(decode(damaged, "a.obj"), importer::Error);
  }
}
