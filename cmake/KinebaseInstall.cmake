# What `cmake --install` puts where: the libraries with a CMake package and a pkg-config file, the
# public headers, and the program with its man page and shell completions.
include(CMakePackageConfigHelpers)

get_property(layers GLOBAL PROPERTY KINEBASE_LAYERS)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kinebase)

install(TARGETS ${layers} kinebase EXPORT kinebase
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/kinebase DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")
install(EXPORT kinebase NAMESPACE kinebase:: FILE kinebaseTargets.cmake DESTINATION ${package_dir})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/kinebaseConfig.cmake.in
  ${PROJECT_BINARY_DIR}/kinebaseConfig.cmake INSTALL_DESTINATION ${package_dir}
  NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change what a program sees.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/kinebaseConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kinebaseConfig.cmake
  ${PROJECT_BINARY_DIR}/kinebaseConfigVersion.cmake DESTINATION ${package_dir})

# A linker reads static libraries once, left to right: users before what they use.
list(REVERSE layers)
list(TRANSFORM layers PREPEND "-l" OUTPUT_VARIABLE pc_libraries)
list(JOIN pc_libraries " " pc_libraries)
set(pc_dependencies "libhwy tomlplusplus cairo tbb zlib libzip tinygltf sqlite3 libxxhash")
if(BUILD_SHARED_LIBS)
  set(pc_requires "eigen3 fmt")
  set(pc_requires_private ${pc_dependencies})
else()
  set(pc_requires "eigen3 fmt ${pc_dependencies}")
  set(pc_requires_private "")
endif()
file(RELATIVE_PATH pc_prefix_from_file "/prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/prefix")
configure_file(${PROJECT_SOURCE_DIR}/cmake/kinebase.pc.in ${PROJECT_BINARY_DIR}/kinebase.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/kinebase.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(TARGETS kinebase_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The program writes its own man page and completions, so they never lag behind its options.
function(kinebase_install_written_by_program file destination)
  set(written ${PROJECT_BINARY_DIR}/written/${file})
  add_custom_command(OUTPUT ${written}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/written
    COMMAND kinebase_cli ${ARGN} > ${written}
    DEPENDS kinebase_cli VERBATIM)
  set_property(GLOBAL APPEND PROPERTY KINEBASE_WRITTEN ${written})
  install(FILES ${written} DESTINATION ${destination})
endfunction()
kinebase_install_written_by_program(kinebase.1 ${CMAKE_INSTALL_MANDIR}/man1 manual)
kinebase_install_written_by_program(kinebase ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  completion bash)
kinebase_install_written_by_program(_kinebase ${CMAKE_INSTALL_DATADIR}/zsh/site-functions
  completion zsh)
kinebase_install_written_by_program(kinebase.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
  completion fish)
get_property(written GLOBAL PROPERTY KINEBASE_WRITTEN)
add_custom_target(kinebase_written ALL DEPENDS ${written})
