# What `cmake --install` writes: the library, its headers, the program, and a package for find_package(vantage).
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/vantage)

install(TARGETS ${VANTAGE_BUILT_LIBRARIES} EXPORT vantage-targets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/vantage DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h")
if(TARGET vantage_cli)
  # Relative, so that the installed tree may be moved as a whole. It may name its folders otherwise than the build tree.
  file(RELATIVE_PATH to_library ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  if(BUILD_SHARED_LIBS)
    set(search_path "$ORIGIN/../lib" "$ORIGIN/${to_library}")
    list(REMOVE_DUPLICATES search_path)
    set_target_properties(vantage_cli PROPERTIES INSTALL_RPATH "${search_path}")
  endif()
  install(TARGETS vantage_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

  # Man pages and completions: the program writes them from its own options, after each link. Where it cannot run, or
  # only slowly, there are none.
  if(NOT CMAKE_CROSSCOMPILING AND NOT VANTAGE_SANITIZE)
    set(share ${CMAKE_BINARY_DIR}/share)
    set(man ${share}/man/man1)
    set(bash ${share}/bash-completion/completions)
    set(zsh ${share}/zsh/site-functions)
    set(fish ${share}/fish/vendor_completions.d)
    add_custom_command(TARGET vantage_cli POST_BUILD
      COMMAND ${CMAKE_COMMAND} -E rm -rf ${share}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${bash} ${zsh} ${fish}
      COMMAND vantage_cli docs man ${man}
      COMMAND vantage_cli docs completion bash -o ${bash}/vantage
      COMMAND vantage_cli docs completion zsh -o ${zsh}/_vantage
      COMMAND vantage_cli docs completion fish -o ${fish}/vantage.fish
      COMMENT "Writing man pages and completions" VERBATIM)
    install(DIRECTORY ${man} DESTINATION ${CMAKE_INSTALL_MANDIR})
    install(DIRECTORY ${share}/bash-completion ${share}/zsh ${share}/fish DESTINATION ${CMAKE_INSTALL_DATADIR})
  endif()
  # The page, where `make web` has built it.
  install(FILES ${PROJECT_SOURCE_DIR}/web/dist/index.html ${PROJECT_SOURCE_DIR}/web/dist/report.html
          DESTINATION ${CMAKE_INSTALL_DATADIR}/vantage/web OPTIONAL)
endif()

install(EXPORT vantage-targets NAMESPACE vantage:: DESTINATION ${package_dir})
set(VANTAGE_SHARED ${BUILD_SHARED_LIBS})
if(NOT VANTAGE_SHARED)
  set(VANTAGE_SHARED OFF)
endif()
set(VANTAGE_INSTALLED_MANIFOLD_USED OFF)
if(VANTAGE_WITH_MISSIONS AND VANTAGE_INSTALLED_MANIFOLD)
  set(VANTAGE_INSTALLED_MANIFOLD_USED ON)
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/vantage-config.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/vantage-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/vantage-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vantage-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/vantage-config-version.cmake
        DESTINATION ${package_dir})

# Our licence, and those of the code that is compiled into the library and the program. A missing text stops the
# installation: it may not be passed on without.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD-PARTY-NOTICES.txt
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
set(licences "cdt/LICENSE=CDT" "cdt/LICENSE-predicates.txt=CDT-predicates" "cdt/LICENSE-LLVM.txt=CDT-LLVM")
if(VANTAGE_WITH_MISSIONS AND NOT VANTAGE_INSTALLED_MANIFOLD)  # else it is linked from where it is installed
  list(APPEND licences "manifold/LICENSE=Manifold")
endif()
if(VANTAGE_HAS_HIGHS)
  list(APPEND licences "highs/LICENSE.txt=HiGHS" "highs/extern/pdqsort/license.txt=pdqsort"
       "highs/extern/zstr/LICENSE=zstr")
endif()
foreach(licence IN LISTS licences)
  string(REPLACE "=" ";" licence ${licence})
  list(GET licence 0 file)
  list(GET licence 1 name)
  install(FILES ${VANTAGE_DEPS_DIR}/${file} DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.${name})
endforeach()
