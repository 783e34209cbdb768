// NPY header: what an array of NumPy says of itself, before its bytes (numpy.lib.format, versions 1 to 3).

#ifndef RICOCHET_CLIENT_CLI_IO_NPY_HEADER_H_
#define RICOCHET_CLIENT_CLI_IO_NPY_HEADER_H_

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace ricochet::cli {

// Reads the header's text, a dictionary of Python with the keys descr, fortran_order and shape, up to the array's
// bytes. Errors: INVALID_ARGUMENT if the stream ends before.
absl::StatusOr<std::string> ReadNpyHeader(std::istream& stream);

// The lengths along the dimensions; none for a scalar. Nothing if the header does not state them.
std::optional<std::vector<int64_t>> ShapeIn(absl::string_view header);

// Removes the text up to and with the first `mark`. Returns false if there is none.
bool SkipPast(absl::string_view mark, absl::string_view& text);

// Removes the text up to `end`, and returns it.
absl::string_view TakeUntil(char end, absl::string_view& text);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_NPY_HEADER_H_
