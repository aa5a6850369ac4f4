"""vantage in the Processing toolbox of QGIS: visibility volumes of polygons in 3D scenes."""


def classFactory(iface):  # noqa: N802 (QGIS calls it by this name)
    """The plugin. `iface` is None in qgis_process."""
    from .plugin import Plugin

    return Plugin(iface)
