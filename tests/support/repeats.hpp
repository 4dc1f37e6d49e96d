// How often tests repeat what they draw at random.
#pragma once

namespace roadfix::testing {

/// So often, but once with a sanitizer, which takes ten times as long to see the same code at work again.
constexpr auto repeats(auto times) { return ROADFIX_SANITIZED ? decltype(times){1} : times; }

}  // namespace roadfix::testing
