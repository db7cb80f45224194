#include "base/sent_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "base/atomic_file.h"
#include "base/byte_record.h"
#include "base/errors.h"
#include "base/whole_file.h"

namespace catoptric {

ScratchFolder::ScratchFolder() {
  std::error_code unknown;
  std::string name = (std::filesystem::temp_directory_path(unknown) / "catoptric-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    throw IoError({"no temporary folder can be made", name, std::generic_category().message(errno),
                   "set TMPDIR to a folder that can be written"});
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string folder_bytes(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& each : std::filesystem::recursive_directory_iterator(folder))
    if (each.is_regular_file()) files.push_back(each.path());
  std::ranges::sort(files);
  ByteWriter writer;
  writer.put(files.size());
  for (const auto& file : files) {
    auto content = read_whole_file(file);
    if (auto* wrong = std::get_if<ErrorParts>(&content)) {
      wrong->where = file.string();
      throw IoError(std::move(*wrong));
    }
    writer.put(file.lexically_relative(folder).string()).put(std::get<std::string>(content));
  }
  return writer.take();
}

void write_folder(const std::string& bytes, const std::filesystem::path& folder) {
  ByteReader reader(bytes);
  for (auto left = reader.get<std::size_t>(); left > 0; --left) {
    const std::filesystem::path file = folder / reader.get<std::string>();
    std::error_code shown_by_the_write;
    std::filesystem::create_directories(file.parent_path(), shown_by_the_write);
    write_file_whole(file, reader.get<std::string>());
  }
}

}  // namespace catoptric
