// The linker script places the image identity at a fixed offset. Flashing tools read the identity
// (protocol/image_identity.hpp).
#include "protocol/image_identity.hpp"
#include <board/board.hpp>

#include "firmware/application/vectors.hpp"

namespace inkwell::application {

static_assert(sizeof(VectorTable) <= protocol::image_identity_offset);
static_assert(protocol::image_identity_offset == 512,
              "the linker script, boards/facts/stm32f405.ld, has the same number");
static_assert(protocol::image_identity(board::facts.name, INKWELL_VERSION_NUMBERS).board_name() == board::facts.name);

/// The identity and the image must consist of whole words.
struct alignas(4) PlacedIdentity {
  protocol::ImageIdentity identity;
};

[[gnu::section(".image_identity"), gnu::used]] constinit const PlacedIdentity placed_identity{
    protocol::image_identity(board::facts.name, INKWELL_VERSION_NUMBERS)};

}  // namespace inkwell::application
