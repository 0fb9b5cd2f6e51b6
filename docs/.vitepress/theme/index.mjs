// VitePress' own theme without its web fonts, and a little style.
import DefaultTheme from 'vitepress/theme-without-fonts'
import './style.css'

export default DefaultTheme
