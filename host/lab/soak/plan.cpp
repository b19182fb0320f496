#include "host/lab/soak/plan.hpp"

namespace inkwell::soak {

std::vector<Kind> shuffled_deck(Random& random) {
  std::vector<Kind> deck;
  for (std::size_t i = 0; i < kind_table.size(); ++i)
    deck.insert(deck.end(), kind_table[i].cards, static_cast<Kind>(i));
  random.shuffle(deck);
  return deck;
}

}  // namespace inkwell::soak
