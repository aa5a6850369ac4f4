"""How results look when they are added to a project: facets by what bounds the volume there, as in vantage's pictures."""

from qgis.core import (QgsCategorizedSymbolRenderer, QgsFillSymbol, QgsProcessingLayerPostProcessorInterface,
                       QgsRendererCategory)

_CAUSES = {
    "scene": ("0,114,178", "an object hides a part of the target"),
    "range": ("230,159,0", "limit of the range"),
    "target_plane": ("128,128,134", "plane of the target"),
    "navigation": ("0,158,115", "limit of where one may fly"),
    "sensor": ("204,121,167", "limit of the sensor"),
}


def style_by_cause(layer):
    """Colours facets by their field cause_kind."""
    categories = []
    for kind, (colour, label) in _CAUSES.items():
        symbol = QgsFillSymbol.createSimple({"color": f"{colour},140", "outline_color": f"{colour},255",
                                             "outline_width": "0.1"})
        categories.append(QgsRendererCategory(kind, symbol, label))
    layer.setRenderer(QgsCategorizedSymbolRenderer("cause_kind", categories))
    layer.triggerRepaint()


class ByCause(QgsProcessingLayerPostProcessorInterface):
    """Styles a layer of facets after it was loaded."""

    instance = None  # QGIS does not keep it alive itself

    def postProcessLayer(self, layer, context, feedback):  # noqa: N802
        style_by_cause(layer)

    @classmethod
    def kept(cls):
        cls.instance = cls()
        return cls.instance
