#include "base/sent_folder.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "base/errors.h"
#include "support/temporary_folder.h"

using namespace catoptric;

TEST_CASE("a folder sent as bytes is made again with every file below it to the last byte") {
  const test::TemporaryFolder from, to;
  std::filesystem::create_directories(from / "figures/more");
  const std::string binary("\0\xff\r\n", 4);
  std::ofstream(from / "figures/more/a.svg", std::ios::binary) << binary;
  std::ofstream(from / "empty.csv");
  write_folder(folder_bytes(from.path()), to.path());
  CHECK(test::read_whole(to / "figures/more/a.svg") == binary);
  CHECK(std::filesystem::file_size(to / "empty.csv") == 0);
  const auto files = std::filesystem::recursive_directory_iterator(to.path());
  CHECK(std::count_if(begin(files), end(files), [](const auto& each) { return each.is_regular_file(); }) ==
        2);
}

TEST_CASE("a folder that cannot be made again is an error that names the file") {
  const test::TemporaryFolder from, to;
  std::filesystem::create_directories(from / "figures");
  std::ofstream(from / "figures/a.svg") << "x";
  std::ofstream(to / "figures") << "a file stands where the folder would";
  try {
    write_folder(folder_bytes(from.path()), to.path());
    FAIL("written");
  } catch (const IoError& error) {
    CHECK(std::string(error.what()).find("a.svg") != std::string::npos);
  }
}

TEST_CASE("a scratch folder is gone with its user") {
  std::filesystem::path path;
  {
    const ScratchFolder scratch;
    path = scratch.path();
    std::ofstream(path / "file") << "x";
    CHECK(std::filesystem::exists(path / "file"));
  }
  CHECK_FALSE(std::filesystem::exists(path));
}
