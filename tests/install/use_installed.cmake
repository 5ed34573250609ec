# Installs BUILD_DIR below WORK_DIR, moves the result (an installation must not know where it was
# made), builds consumer/ against it in the WAY asked for, and runs that and the installed program.
set(consumer ${CMAKE_CURRENT_LIST_DIR}/consumer)
set(prefix ${WORK_DIR}/moved)
file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nexited with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect_output expected)
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "expected output with \"${expected}\", found:\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/first)
file(RENAME ${WORK_DIR}/first ${prefix})

if(WAY STREQUAL cmake)
  run(${CMAKE_COMMAND} -S ${consumer} -B ${WORK_DIR}/build -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${prefix})
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
  set(program ${WORK_DIR}/build/consumer)
else()
  set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
  run(pkg-config --cflags kinebase)
  separate_arguments(compile_flags UNIX_COMMAND "${output}")
  run(pkg-config --libs kinebase)
  separate_arguments(link_flags UNIX_COMMAND "${output}")
  set(program ${WORK_DIR}/consumer)
  run(${CXX} -std=c++20 ${compile_flags} ${consumer}/consumer.cpp ${link_flags} -o ${program})
endif()

run(${program})
expect_output("39 features, 0 hits")
run(${prefix}/bin/kinebase --version)
expect_output("${VERSION}")
foreach(file share/man/man1/kinebase.1 share/bash-completion/completions/kinebase
        share/zsh/site-functions/_kinebase share/fish/vendor_completions.d/kinebase.fish)
  file(SIZE ${prefix}/${file} size)  # Stops with an error where there is no such file.
  if(size EQUAL 0)
    message(FATAL_ERROR "${prefix}/${file} is empty")
  endif()
endforeach()
file(REMOVE_RECURSE ${WORK_DIR})
