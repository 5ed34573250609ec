# Writes OUTPUT, a source file whose function EmbeddedData_<STEM>() returns the text of INPUT.
# The text goes in as character codes: that has no limit on its length and no delimiter to collide.
file(READ ${INPUT} hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "#include <string_view>
namespace kinebase::internal {
std::string_view EmbeddedData_${STEM}();
std::string_view EmbeddedData_${STEM}() {
  static constexpr unsigned char kBytes[] = {\n${bytes}0};
  return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes) - 1};
}
}  // namespace kinebase::internal
")
