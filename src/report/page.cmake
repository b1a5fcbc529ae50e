# The page of `hemibake report`: npm installs the bundler and the plot library into the build folder (again only when
# their list changes), the bundler makes one HTML file of src/report/web/, and html_template.cpp carries it inside the
# library. Without Node or npm, or with -DHEMIBAKE_REPORT=OFF, the command says that it is left out.
set(page_sources
  albedo.ts build.mjs chart.ts checks.ts color.ts curves.ts data.ts dom.ts index.html main.ts models.ts model.ts package.json
  package-lock.json page.css picture.ts pictures.ts planes.ts probe.ts shader.ts summary.ts surface.ts sweep.ts theme.ts trade.ts tsconfig.json
  viewer.ts viewer_canvas.ts viewer_gl.ts viewer_shader.ts)
list(TRANSFORM page_sources PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/report/web/)
set(page_folder ${CMAKE_BINARY_DIR}/page)
find_program(NODE node)
find_program(NPM npm)

if(HEMIBAKE_REPORT AND NODE AND NPM)
  set(page_packages
    ${CMAKE_CURRENT_SOURCE_DIR}/report/web/package.json ${CMAKE_CURRENT_SOURCE_DIR}/report/web/package-lock.json)
  add_custom_command(OUTPUT ${page_folder}/packages.stamp
    COMMAND ${CMAKE_COMMAND} -E make_directory ${page_folder}
    COMMAND ${CMAKE_COMMAND} -E copy ${page_packages} ${page_folder}
    COMMAND ${CMAKE_COMMAND} -E chdir ${page_folder} ${NPM} ci --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${page_folder}/packages.stamp
    DEPENDS ${page_packages}
    COMMENT "Installing what the report's page is built with (-DHEMIBAKE_REPORT=OFF leaves the report out)" VERBATIM)
  add_custom_command(OUTPUT ${page_folder}/page.html
    COMMAND ${CMAKE_COMMAND} -E copy ${page_sources} ${page_folder}
    COMMAND ${CMAKE_COMMAND} -E chdir ${page_folder} ${NODE} build.mjs
    DEPENDS ${page_sources} ${page_folder}/packages.stamp
    COMMENT "Bundling the report's page" VERBATIM)
  target_sources(hemibake_lib PRIVATE report/html_template.cpp)
  set_source_files_properties(report/html_template.cpp PROPERTIES
    COMPILE_DEFINITIONS "HEMIBAKE_PAGE_FILE=\"${page_folder}/page.html\"" OBJECT_DEPENDS ${page_folder}/page.html)
else()
  message(STATUS "hemibake report is left out: it needs Node, npm and HEMIBAKE_REPORT=ON")
  target_sources(hemibake_lib PRIVATE report/html_no_template.cpp)
endif()
