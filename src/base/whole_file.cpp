#include "base/whole_file.h"

#include <fstream>
#include <system_error>

namespace catoptric {
namespace {

ErrorParts defect(std::string what, const std::filesystem::path& file, std::string why, std::string hint) {
  return {std::move(what), file.string(), std::move(why), std::move(hint)};
}

}  // namespace

std::variant<std::string, ErrorParts> read_whole_file(const std::filesystem::path& file,
                                                      std::uintmax_t most_bytes) {
  namespace fs = std::filesystem;
  if (file.native().find('\0') != std::string::npos)
    return defect("this is no name of a file", file.native().substr(0, file.native().find('\0')),
                  "it holds the character NUL", "check the name");
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    return defect("there is no such file", file, "", "check the path");
  if (error) return defect("the file cannot be read", file, error.message(), "check the path");
  if (fs::is_directory(status))
    return defect("this is a folder, not a file", file, "a file is needed", "name a file in it");
  if (!fs::is_regular_file(status))
    return defect("this is not a file", file, "it is a pipe or a device, which may have no end",
                  "save its content as a file");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return defect("the file cannot be read", file, error.message(), "check its permissions");
  if (size > most_bytes)
    return defect("the file is too large", file,
                  "files up to " + std::to_string(most_bytes >> 20) + " MiB are read", "take a part of it");
  std::ifstream in(file, std::ios::binary);
  std::string content(size, '\0');
  in.read(content.data(), static_cast<std::streamsize>(size));
  content.resize(static_cast<std::size_t>(in.gcount()));
  if (!in.is_open() || in.bad()) return defect("the file cannot be read", file, "", "check its permissions");
  return content;
}

}  // namespace catoptric
