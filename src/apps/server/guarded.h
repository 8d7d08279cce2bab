// SPDX-License-Identifier: Apache-2.0
// Where results and exceptions of the server's work become what is sent.
#pragma once

#include <functional>

#include "apps/server/http.h"
#include "core/base/json_fwd.h"

namespace cei3d {

// Bytes that are no UTF-8 are replaced.
std::string text_of(const Json&);

// The response of the work; errors become responses with their sentence.
HttpResponse guarded_response(const std::function<HttpResponse()>& work);

}  // namespace cei3d
