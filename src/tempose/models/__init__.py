"""The container of saved models: one ``.tempose`` file, arrays under a JSON header, no pickle."""

from tempose.models.container import FORMAT_VERSION, load_model, save_model
from tempose.models.tree import ValueTree

__all__ = ["FORMAT_VERSION", "ValueTree", "load_model", "save_model"]
