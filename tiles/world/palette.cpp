#include "tiles/world/palette.hpp"

#include <array>

namespace roadfix::world::palette {

Colour varied(const Colour& base, double amount, Random& random) {
  const double brightness = 1.0 + amount * random.uniform(-1.0, 1.0);
  Colour result;
  for (int i = 0; i < 3; ++i) result[i] = base[i] * brightness * (1.0 + 0.25 * amount * random.uniform(-1.0, 1.0));
  return result;
}

Colour flat_roof(Random& random) {
  static const std::array<Colour, 5> kTones{
      {{208, 196, 178}, {194, 182, 164}, {178, 168, 154}, {160, 152, 142}, {220, 212, 200}}};
  return varied(kTones[random.index(kTones.size())], 0.09, random);
}

Colour tile_roof(Random& random) {
  static const std::array<Colour, 4> kTones{{{172, 112, 90}, {150, 84, 76}, {184, 128, 104}, {136, 100, 88}}};
  return varied(kTones[random.index(kTones.size())], 0.12, random);
}

Colour metal_roof(Random& random) {
  static const std::array<Colour, 4> kTones{{{226, 224, 218}, {206, 204, 200}, {128, 148, 172}, {186, 178, 168}}};
  return varied(kTones[random.index(kTones.size())], 0.06, random);
}

Colour facade(Random& random) { return varied({196, 184, 158}, 0.2, random); }

Colour lot(Random& random) {
  static const std::array<Colour, 6> kTones{{kConcrete, kGravel, kSoil, kGarden, kRedSoil, kDryGrass}};
  return varied(kTones[random.index(kTones.size())], 0.14, random);
}

Colour car(Random& random) {
  static const std::array<Colour, 8> kTones{{{232, 232, 230},
                                             {225, 225, 222},
                                             {190, 192, 194},
                                             {150, 152, 155},
                                             {60, 62, 66},
                                             {44, 46, 50},
                                             {150, 52, 48},
                                             {62, 84, 130}}};
  return kTones[random.index(kTones.size())];
}

}  // namespace roadfix::world::palette
