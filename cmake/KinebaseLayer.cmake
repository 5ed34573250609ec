# kinebase_layer(<name> DEPENDS <layers…> PUBLIC <libraries…> PRIVATE <libraries…> DATA <files…>)
#
# One layer of the library: every src/<name>/**.cpp, its public headers in include/kinebase/<name>.
# DATA files are compiled in; `internal::EmbeddedData_<stem>()` returns their text.
function(kinebase_layer name)
  cmake_parse_arguments(layer "" "" "DEPENDS;PUBLIC;PRIVATE;DATA" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  foreach(data IN LISTS layer_DATA)
    kinebase_embed(${data} embedded)
    list(APPEND sources ${embedded})
  endforeach()
  set(target kinebase_${name})
  add_library(${target} ${sources})
  add_library(kinebase::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  list(TRANSFORM layer_DEPENDS PREPEND kinebase_)
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PUBLIC ${layer_DEPENDS} ${layer_PUBLIC} PRIVATE ${layer_PRIVATE})
  kinebase_compile_options(${target})
  set_property(GLOBAL APPEND PROPERTY KINEBASE_LAYERS ${target})
endfunction()

# Options that every target of ours shares.
function(kinebase_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # Contraction would let the same sum come out differently on machines with and without FMA.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(KINEBASE_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
      -Wno-sign-conversion -Werror
      # Designated initialisers that leave fields at their defaults are what we want.
      -Wno-missing-field-initializers)
  endif()
  if(KINEBASE_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${KINEBASE_SANITIZE}
      -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${KINEBASE_SANITIZE})
    if(KINEBASE_SANITIZE MATCHES thread)
      target_compile_definitions(${target} PRIVATE KINEBASE_THREAD_SANITIZER=1)
    endif()
  endif()
endfunction()

# Turns a data file into a source file that defines `internal::EmbeddedData_<stem>()`.
function(kinebase_embed file out)
  get_filename_component(stem ${file} NAME_WE)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_${stem}.cpp)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${PROJECT_SOURCE_DIR}/${file} -DOUTPUT=${source} -DSTEM=${stem}
      -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFile.cmake
    DEPENDS ${PROJECT_SOURCE_DIR}/${file} ${PROJECT_SOURCE_DIR}/cmake/EmbedFile.cmake
    VERBATIM)
  set(${out} ${source} PARENT_SCOPE)
endfunction()
