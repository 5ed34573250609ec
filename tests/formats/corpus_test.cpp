// Replays fuzz/corpus: files named good_… are read, bad_… are refused with a message that names
// them, all others end in either.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include "kinebase/core/error.h"
#include "kinebase/formats/amc.h"
#include "kinebase/formats/asf.h"
#include "kinebase/formats/bvh.h"
#include "kinebase/formats/c3d.h"
#include "kinebase/formats/csm.h"
#include "kinebase/formats/mat.h"
#include "kinebase/formats/mnm.h"
#include "kinebase/formats/npz.h"
#include "kinebase/formats/sto.h"
#include "kinebase/formats/trc.h"
#include "support/files.h"

namespace kinebase {
namespace {

std::filesystem::path Corpus(std::string_view format) {
  return std::filesystem::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / format;
}

// Calls `read` for every file. It may throw nothing but kinebase::Error.
void Replay(std::string_view format,
            const std::function<void(const std::filesystem::path&)>& read) {
  int good = 0;
  int bad = 0;
  for (const auto& entry : std::filesystem::directory_iterator(Corpus(format))) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    bool was_read = false;
    try {
      read(entry.path());
      was_read = true;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      EXPECT_FALSE(name.starts_with("good_")) << error.what();
    }
    EXPECT_FALSE(was_read && name.starts_with("bad_"));
    good += name.starts_with("good_") ? 1 : 0;
    bad += name.starts_with("bad_") ? 1 : 0;
  }
  EXPECT_GE(good, 5);
  EXPECT_GE(bad, 10);
}

TEST(AsfCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("asf", [](const auto& path) {
    const AsfSkeleton asf = ReadAsf(path);
    EXPECT_EQ(ParseAsf(FormatAsf(asf), path), asf);
  });
}

TEST(AmcCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("amc", [](const auto& path) {
    const AmcMotion amc = ReadAmc(path);
    EXPECT_EQ(ParseAmc(FormatAmc(amc), path), amc);
  });
}

TEST(BvhCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("bvh", [](const auto& path) {
    const BvhMotion bvh = ReadBvh(path);
    EXPECT_EQ(ParseBvh(FormatBvh(bvh), path), bvh);
  });
}

TEST(C3dCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("c3d", [](const auto& path) {
    const C3dRecording c3d = ReadC3d(path);
    EXPECT_EQ(ParseC3d(FormatC3d(c3d), path), c3d);
  });
}

TEST(CsmCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("csm", [](const auto& path) {
    const CsmRecording csm = ReadCsm(path);
    EXPECT_EQ(ParseCsm(FormatCsm(csm), path), csm);
  });
}

TEST(MnmCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("mnm", [](const auto& path) {
    const MarkerNames names = ReadMnm(path);
    EXPECT_EQ(ParseMnm(FormatMnm(names), path), names);
  });
}

TEST(TrcCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("trc", [](const auto& path) {
    const TrcRecording trc = ReadTrc(path);
    EXPECT_EQ(ParseTrc(FormatTrc(trc), path), trc);
  });
}

TEST(StoCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("sto", [](const auto& path) {
    const StoTable table = ReadSto(path);
    EXPECT_EQ(ParseSto(FormatSto(table), path), table);
  });
}

TEST(MatCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("mat", [](const auto& path) {
    const MatFile mat = ReadMat(path);
    EXPECT_EQ(ParseMat(FormatMat(mat), path), mat);
  });
}

// Archives, and the single arrays that the fuzz target takes.
TEST(NpzCorpus, IsReadOrRefusedAsItsNamesSay) {
  Replay("npz", [](const auto& path) {
    if (path.extension() == ".npz") {
      const NpzArchive archive = ReadNpz(path);
      EXPECT_EQ(ParseNpz(FormatNpz(archive), path), archive);
    } else {
      const NpzArray array = ParseNpy(test::ReadText(path), "array", path);
      EXPECT_EQ(ParseNpy(FormatNpy(array), "array", path), array);
    }
  });
}

}  // namespace
}  // namespace kinebase
