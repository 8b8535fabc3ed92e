"""Export to other programs: motions of all rows on their mesh, and contact forces for stress recovery."""

from fcm.export.motions import motions_of
from fcm.export.options import EXPORT, ExportOptions

__all__ = ["EXPORT", "ExportOptions", "motions_of"]
