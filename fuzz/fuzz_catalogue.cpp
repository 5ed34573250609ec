// Any bytes as the catalogue of a library: reading, verifying, finding and changing it gives what
// is safe to use or a kinebase::Error, and never runs for ever.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/library/library_annotations.h"
#include "kinebase/library/library_compaction.h"
#include "kinebase/library/library_labels.h"
#include "kinebase/library/library_templates.h"
#include "kinebase/library/library_upkeep.h"
#include "kinebase/library/take_library.h"

namespace {

namespace fs = std::filesystem;

// A folder for the library of one process, gone at its end.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("fuzz_catalogue." + std::to_string(::getpid()))) {}
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void Fill(std::string_view catalogue) const {
    fs::remove_all(path_);
    fs::create_directories(path_ / "segments");
    std::ofstream(path_ / "catalogue.sqlite", std::ios::binary) << catalogue;
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Another exception than kinebase::Error leaves through here and is a finding.
void Try(const std::function<void()>& use) {
  try {
    use();
  } catch (const kinebase::Error& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
}

void Read(const fs::path& library) {
  Try([&] {
    const kinebase::TakeLibrary opened(library);
    for (const kinebase::StoredTake& take : opened.takes()) {
      Try([&] { opened.Check(take); });
    }
    Try([&] { (void)opened.Choose({.text = "a b"}); });
  });
  Try([&] { (void)kinebase::VerifyLibrary(library, 1); });
  Try([&] {
    for (const auto& stored : kinebase::ListTemplates(library)) {
      Try([&] { (void)kinebase::LoadTemplate(library, stored.name); });
    }
  });
  Try([&] { (void)kinebase::ListAnnotations(library, {}); });
}

void Change(const fs::path& library) {
  Try([&] { kinebase::ChangeLabels(library, {}, {.add = {"a"}}); });
  Try([&] { kinebase::RemoveTakes(library, {.damaged = true}); });
  Try([&] { kinebase::CompactLibrary(library); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  folder.Fill({reinterpret_cast<const char*>(data), size});
  Read(folder.path());
  Change(folder.path());
  Read(folder.path());
  return 0;
}
