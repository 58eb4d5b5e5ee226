#include "daemon/replay/csv_file.hpp"

#include <cerrno>
#include <cstring>

namespace hulltrack {

Result<CsvFile> CsvFile::create(const std::filesystem::path& file, const char* header, const char* option) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) {
    return Error{file.string() + ": " + std::strerror(errno) + "; choose another file with " + option};
  }
  CsvFile csv(file.string(), stream);
  if (Result<void> written = csv.write(header); !written) {
    return written.error();
  }
  return csv;
}

Result<void> CsvFile::write(const std::string& line) {
  if (std::fwrite(line.data(), 1, line.size(), stream_.get()) != line.size() ||
      std::fputc('\n', stream_.get()) == EOF) {
    return Error{name_ + ": " + std::strerror(errno)};
  }
  return {};
}

Result<void> CsvFile::close() {
  if (std::fclose(stream_.release()) != 0) {
    return Error{name_ + ": " + std::strerror(errno)};
  }
  return {};
}

}  // namespace hulltrack
