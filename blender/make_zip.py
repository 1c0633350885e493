"""make_zip.py PACKAGE OUT.zip: the add-on with the built package `batten` inside, as Preferences > Add-ons installs it."""

import pathlib
import sys
import zipfile

addon = pathlib.Path(__file__).resolve().parent / "batten_addon"
package, target = map(pathlib.Path, sys.argv[1:3])
with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
    for file in sorted(addon.glob("*.py")):
        archive.write(file, f"batten_addon/{file.name}")
    for file in sorted(package.iterdir()):
        if file.name.startswith("_volumes"):  # needs ITK, and no operator reads volumes
            continue
        if file.suffix in {".py", ".pyi", ".so", ".typed"} or file.name == "py.typed":
            archive.write(file, f"batten_addon/vendor/batten/{file.name}")
