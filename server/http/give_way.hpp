// Work that takes the processors only where nobody else wants them.
#pragma once

#include <functional>

#include "server/http/message.hpp"

namespace roadfix::http {

/// What `work` returns, in a thread of a lower priority than the others of the process; where the system gives no
/// thread, in this one. Throws what `work` throws.
Response giving_way(const std::function<Response()>& work);

}  // namespace roadfix::http
