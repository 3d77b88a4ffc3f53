"""Learned detail: the cloth and flesh that a skeleton alone does not carry."""
