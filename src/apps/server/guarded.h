// SPDX-License-Identifier: Apache-2.0
// Where exceptions of the server's work become responses.
#pragma once

#include <functional>

#include "apps/server/http.h"

namespace cei3d {

// The response of the work; errors become responses with their sentence.
HttpResponse guarded_response(const std::function<HttpResponse()>& work);

}  // namespace cei3d
