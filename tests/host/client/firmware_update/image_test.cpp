#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/client/firmware_update/boot_loader.hpp"
#include "host/client/firmware_update/flash_file.hpp"
#include "host/client/firmware_update/image.hpp"
#include "host/client/firmware_update/update.hpp"
#include "host/client/local/owned_file.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/host/client/firmware_update/made_elf.hpp"

using namespace inkwell;
using namespace inkwell::firmware_update;
using inkwell::tests::contains;
using inkwell::tests::made_elf;
using inkwell::tests::made_segments;
using inkwell::tests::message_of;

namespace {

Image image_of(const std::vector<Segment>& segments) { return read_image(made_elf(segments), "made.elf"); }

std::string board_in(const std::string& flash) {
  const auto identity = identity_in(std::as_bytes(std::span(flash)));
  return identity ? std::string(identity->board_name()) : std::string();
}

std::array<std::uint8_t, 3> version_in(const std::string& flash) {
  return identity_in(std::as_bytes(std::span(flash))).value().version();
}

std::string refusal_of(const std::vector<Segment>& segments) {
  return message_of<NoImage>([&] { image_of(segments); });
}

protocol::ImageIdentity identity_of(std::string_view board, int versions_off = 0) {
  auto identity = protocol::image_identity(board, 1, 2, 3);
  identity.protocol_version = static_cast<std::uint16_t>(identity.protocol_version + versions_off);
  return identity;
}

}  // namespace

TEST_CASE("the firmware image is complete and contains its identity") {
  const auto image = read_image(INKWELL_BUILD_DIRECTORY "/../board/inkwell.elf");
  REQUIRE(image.identity.has_value());
  CHECK(image.identity->board_name() == "omni_driver");
  CHECK(image.identity->protocol_version == protocol::protocol_version);
  CHECK(image.is_whole);
  CHECK(objections(image, image.identity).empty());
  CHECK(objections(image, {}).empty());
}

TEST_CASE("a file that is no program for the chip's flash is refused with a sentence") {
  CHECK(contains(message_of<NoImage>([] { read_image(std::span<const std::byte>(), "none.elf"); }), "not an ELF"));
  CHECK(contains(message_of<NoImage>([] { read_image("/nowhere/at/all.elf"); }), "does not exist"));
  CHECK(contains(message_of<NoImage>([] { read_image("/tmp"); }), "does not exist"));
  CHECK(contains(message_of<NoImage>([] { read_image("/bin/sh"); }), "32-bit ARM"));
  const auto good = made_elf(made_segments(identity_of("omni_driver")));
  REQUIRE_NOTHROW(read_image(good, "made.elf"));
  for (std::size_t length = 4; length < good.size(); length += 7)
    CHECK_THROWS_AS(read_image(std::span(good).first(length), "cut.elf"), NoImage);
  CHECK(contains(refusal_of({}), "vector table"));
  CHECK(contains(refusal_of({{0x0800'4000, std::vector<std::byte>(8)}}), "vector table"));
  CHECK(contains(refusal_of({{0x0800'0000, std::vector<std::byte>(8)}, {0x080F'FFFC, std::vector<std::byte>(8)}}),
                 "not a program for the flash"));
  CHECK(contains(refusal_of({{0x0800'0000, std::vector<std::byte>(8)}, {0x0800'0004, std::vector<std::byte>(8)}}),
                 "not a program for the flash"));
  CHECK(contains(refusal_of({{0x2000'0000, std::vector<std::byte>(8)}}), "not a program for the flash"));
}

TEST_CASE("an image is objected to for another board, another protocol, damage, and for saying nothing") {
  const auto there = identity_of("omni_driver");
  CHECK(objections(image_of(made_segments(identity_of("omni_driver"))), there).empty());
  CHECK(objections(image_of(made_segments(identity_of("other_board"))), {}).empty());  // unknown board

  const auto only_objection = [&](const Image& image) {
    const auto all = objections(image, there);
    REQUIRE(all.size() == 1);
    CHECK_NOTHROW(insist(image, there, Consent::to_everything));
    CHECK_THROWS_AS(insist(image, there, Consent::to_downgrade), Objected);
    const auto said = message_of<Objected>([&] { insist(image, there, Consent::none); });
    CHECK(contains(said, all[0]));
    CHECK(contains(said, "Nothing was changed"));
    return all[0];
  };
  CHECK(contains(only_objection(image_of(made_segments(identity_of("other_board")))), "other_board"));
  for (const int step : {-1, +1})
    CHECK(contains(only_objection(image_of(made_segments(identity_of("omni_driver", step)))), "not compatible"));
  auto damaged = made_segments(identity_of("omni_driver"));
  damaged[1].bytes[5] ^= std::byte{1};
  CHECK(contains(only_objection(image_of(damaged)), "damaged"));
  auto nameless = made_segments(identity_of("omni_driver"));
  nameless[0].bytes[protocol::image_identity_offset] = std::byte{0};
  CHECK(contains(only_objection(image_of(nameless)), "does not state its board"));
}

TEST_CASE("an image that is older than the firmware that is there needs consent to a downgrade") {
  const auto image_with = [](std::uint8_t major, std::uint8_t minor, std::uint8_t patch) {
    return image_of(made_segments(protocol::image_identity("omni_driver", major, minor, patch)));
  };
  const auto there = protocol::image_identity("omni_driver", 1, 2, 3);
  for (const auto& newer : {image_with(1, 2, 3), image_with(1, 2, 4), image_with(1, 10, 0), image_with(2, 0, 0)})
    CHECK_NOTHROW(insist(newer, there, Consent::none));
  for (const auto& older : {image_with(1, 2, 2), image_with(1, 1, 9), image_with(0, 255, 255)}) {
    CHECK(contains(message_of<Downgrade>([&] { insist(older, there, Consent::none); }),
                   "older than the installed firmware 1.2.3"));
    CHECK_NOTHROW(insist(older, there, Consent::to_downgrade));
    CHECK_NOTHROW(insist(older, there, Consent::to_everything));
    CHECK_NOTHROW(insist(older, {}, Consent::none));
  }
  // Consent to a downgrade does not permit an invalid image.
  const auto wrong = image_of(made_segments(protocol::image_identity("other_board", 1, 0, 0)));
  CHECK_THROWS_AS(insist(wrong, there, Consent::to_downgrade), Objected);
  const auto said = message_of<Objected>([&] { insist(wrong, there, Consent::none); });
  CHECK(contains(said, "other_board"));
  CHECK(contains(said, "older"));
}

TEST_CASE("memory layouts are read as ST writes them") {
  const auto sectors = parse_memory_layout("@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg");
  REQUIRE(sectors.size() == 12);
  CHECK(sectors[0] == Sector{0x0800'0000, 0x4000});
  CHECK(sectors[3] == Sector{0x0800'C000, 0x4000});
  CHECK(sectors[4] == Sector{0x0801'0000, 0x1'0000});
  CHECK(sectors[11] == Sector{0x080E'0000, 0x2'0000});
  CHECK(parse_memory_layout("@Option Bytes  /0x1FFFC000/01*016 e") == std::vector{Sector{0x1FFF'C000, 16}});
  for (const char* text : {"", "Internal Flash", "@Internal Flash", "@F/0x08000000", "@F/0x08000000/",
                           "@F/08000000/1*1Kg", "@F/0x08000000/99999*1Kg", "@F/0x08000000/1*99999999Kg",
                           "@F/0x08000000/1*1Kg;", "@F/0x08000000/0*1Kg", "@F/0xFFFFFFFFF/1*1Kg"}) {
    INFO(text);
    CHECK(parse_memory_layout(text).empty());
  }
  const auto image = image_of(made_segments(identity_of("omni_driver")));
  CHECK(sectors_of(image, sectors) == std::vector{sectors[0], sectors[4]});  // and no sector between them
}

TEST_CASE("of the option bytes only the brown-out level changes") {
  std::array<std::byte, BootLoader::option_bytes> options{};
  for (std::size_t i = 0; i < options.size(); ++i) options[i] = std::byte(0xE0 + i);
  options[0] = std::byte{0xEF};
  options[1] = std::byte{0xAA};
  const auto changed = with_brown_out_level_3(options);
  REQUIRE(changed.has_value());
  CHECK((*changed)[0] == std::byte{0xE3});
  CHECK(std::equal(changed->begin() + 1, changed->end(), options.begin() + 1));
  CHECK_FALSE(with_brown_out_level_3(*changed).has_value());
  // Read-protected or misread option bytes are not changed. Protection level 2 (0xCC) would lock the chip permanently.
  for (const int protection : {0x00, 0xCC, 0xFF, 0x55}) {
    options[1] = std::byte(protection);
    CHECK_THROWS_AS(with_brown_out_level_3(options), device::Error);
  }
}

TEST_CASE("a virtual board's flash file gets the image's sectors, and keeps the others") {
  const tests::TemporaryDirectory directory;
  const std::filesystem::path file = directory.file("board.flash");
  const auto image = image_of(made_segments(identity_of("omni_driver")));
  CHECK_FALSE(write_flash_file(file, image, Consent::none).before.has_value());
  REQUIRE(std::filesystem::file_size(file) == 1024 * 1024);
  const auto content = [&] {
    std::ifstream stream(file, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  auto flash = content();
  CHECK(std::memcmp(flash.data(), image.segments[0].bytes.data(), image.segments[0].bytes.size()) == 0);
  CHECK(std::memcmp(flash.data() + 0x1'0000, image.segments[1].bytes.data(), image.segments[1].bytes.size()) == 0);
  constexpr std::size_t parameters = 0x8000, unused = 0x1'FFF0;
  CHECK(flash[parameters] == '\xFF');
  flash[parameters] = 'p';
  flash[unused] = 'u';
  std::ofstream(file, std::ios::binary) << flash;
  const auto before = write_flash_file(file, image, Consent::none).before;
  REQUIRE(before.has_value());
  CHECK(before->board_name() == "omni_driver");
  CHECK(content()[parameters] == 'p');
  CHECK(content()[unused] == '\xFF');  // this file area shares a sector with the image

  const auto other = image_of(made_segments(identity_of("other_board")));
  CHECK_THROWS_AS(write_flash_file(file, other, Consent::none), Objected);
  CHECK(board_in(content()) == "omni_driver");
  CHECK_NOTHROW(write_flash_file(file, other, Consent::to_everything));
  CHECK(board_in(content()) == "other_board");
  write_flash_file(file, image, Consent::none, [&](const auto& there) {
    CHECK(there == "other_board");
    return other;
  });
  CHECK(board_in(content()) == "other_board");

  const auto older = image_of(made_segments(protocol::image_identity("other_board", 0, 9, 0)));
  CHECK_THROWS_AS(write_flash_file(file, older, Consent::none), Downgrade);
  CHECK(version_in(content()) == std::array<std::uint8_t, 3>{1, 2, 3});
  CHECK_NOTHROW(write_flash_file(file, older, Consent::to_downgrade));
  CHECK(version_in(content()) == std::array<std::uint8_t, 3>{0, 9, 0});

  std::ofstream(file, std::ios::binary) << "a text";
  CHECK(contains(message_of<device::Error>([&] { write_flash_file(file, image, Consent::to_everything); }),
                 "not a flash file of a virtual board"));
  CHECK(content() == "a text");
  CHECK_THROWS_AS(write_flash_file("/nowhere/board.flash", image, Consent::to_everything), device::Error);
  CHECK(
      contains(message_of<device::Error>([&] { write_flash_file(directory.file(""), image, Consent::to_everything); }),
               "not a flash file of a virtual board"));

  {
    const local::OwnedFile owned(file);  // as a running board owns its file
    CHECK(contains(message_of<device::Error>([&] { write_flash_file(file, image, Consent::to_everything); }),
                   "is in use by"));
  }

  // This file has the size of the flash but contains no flash image.
  const std::string pictures(protocol::flash_bytes, 'P');
  std::ofstream(file, std::ios::binary) << pictures;
  CHECK(contains(message_of<device::Error>([&] { write_flash_file(file, image, Consent::to_everything); }),
                 "not a flash file of a virtual board"));
  CHECK(content() == pictures);
}

TEST_CASE("may_be_flash accepts content whose vectors point into the flash or are erased") {
  std::vector<std::byte> flash(protocol::flash_bytes, std::byte{0xFF});
  const auto with_vectors = [&](std::uint32_t stack, std::uint32_t first_instruction) {
    std::memcpy(flash.data(), &stack, sizeof stack);
    std::memcpy(flash.data() + sizeof stack, &first_instruction, sizeof first_instruction);
    return protocol::may_be_flash(flash);
  };
  CHECK(with_vectors(0xFFFF'FFFF, 0xFFFF'FFFF));
  CHECK(with_vectors(0x2000'0000, 0x0800'0201));
  CHECK(with_vectors(0x2000'0000, 0x080F'FFFF));
  CHECK_FALSE(with_vectors(0x2000'0000, 0xFFFF'FFFF));
  CHECK_FALSE(with_vectors(0xFFFF'FFFF, 0x0000'0201));
  CHECK_FALSE(with_vectors(0x2000'0000, 0x0800'0200));  // not Thumb code
  CHECK_FALSE(with_vectors(0x2000'0000, 0x0810'0001));
  CHECK_FALSE(with_vectors(0x2000'0000, 0x07FF'FFFF));
  CHECK(with_vectors(0x2000'0000, 0x0800'0201));
  flash.pop_back();
  CHECK_FALSE(protocol::may_be_flash(flash));
  CHECK_FALSE(protocol::may_be_flash({}));
}
