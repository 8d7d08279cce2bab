// SPDX-License-Identifier: Apache-2.0
// Turns results and exceptions of the server's work into text and responses.
#pragma once

#include <functional>

#include "apps/server/http.h"
#include "core/base/json_fwd.h"

namespace cei3d {

// JSON as text. Bytes that are not UTF-8 are replaced.
std::string text_of(const Json&);

// The response of the work, or, if it throws, an error response with the message of the exception.
HttpResponse guarded_response(const std::function<HttpResponse()>& work);

}  // namespace cei3d
